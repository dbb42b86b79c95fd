"""Cues by their words: what comes out, and what is refused."""

import pytest

from multilens.app.cues import build_cues, check_cues
from multilens.app.refusal import RefusedError
from multilens.app.schema import CueName, CuesConfig, PairLimitsConfig
from multilens.cues import LensDefocus, LimitedStereo, PairLimits, PairStereo


def config(*names: str, **limits: float) -> CuesConfig:
    return CuesConfig([CueName[name] for name in names], PairLimitsConfig(**limits))


def test_cues_come_in_the_order_in_which_they_are_named():
    assert build_cues(config("defocus", "stereo")) == [LensDefocus(), PairStereo()]


def test_limits_are_those_of_the_limited_cue():
    assert build_cues(config("limited_stereo", max_disparity=0.5, least_overlap=0.25)) == [
        LimitedStereo(PairLimits(0.5, 0.25))
    ]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (config(), "cues.names must be at least one of .*, each once, got none"),
        (config("stereo", "stereo"), "cues.names must be at least one of .*, each once, got stereo, stereo"),
        (config("limited_stereo", max_disparity=0.0), "cues.limits.max_disparity must be > 0 mm and finite, .* got 0"),
        (config("limited_stereo", least_overlap=1.0), "cues.limits.least_overlap must be >= 0 and < 1, got 1"),
        (config("stereo", least_overlap=0.5), "cues.limits are for limited_stereo, got cues.names of stereo"),
    ],
)
def test_what_does_not_go_together_is_refused(given, message):
    with pytest.raises(RefusedError, match=message):
        check_cues(given)
