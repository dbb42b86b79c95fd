"""Cues by their words: what comes out, and what is refused."""

import pytest

from multilens.app.cues import build_cues, check_cues
from multilens.app.refusal import RefusedError
from multilens.app.schema_cues import CueName, CuesConfig, PairLimitsConfig, RelativeErrorsConfig, TwoImagesConfig
from multilens.cues import (
    LensDefocus,
    LimitedStereo,
    PairLimits,
    PairStereo,
    PhotometricDefocus,
    PhotometricStereo,
    PrintedDefocus,
)
from multilens.scene import Scene

SCENE = Scene(0.2, 50, 500, 33.3, 1089)


def config(*names: str, **limits: float) -> CuesConfig:
    return CuesConfig([CueName[name] for name in names], PairLimitsConfig(**limits))


def test_cues_come_in_the_order_in_which_they_are_named():
    assert build_cues(config("defocus", "stereo"), SCENE) == [LensDefocus(), PairStereo()]


def test_limits_are_those_of_the_limited_cue():
    assert build_cues(config("limited_stereo", max_disparity=0.5, least_overlap=0.25), SCENE) == [
        LimitedStereo(PairLimits(0.5, 0.25))
    ]


def images(*numbers: float) -> CuesConfig:
    return CuesConfig([CueName["photometric_defocus"]], two_images=TwoImagesConfig(*numbers))


def errors(*numbers: float) -> CuesConfig:
    return CuesConfig([CueName["printed_defocus"]], relative_errors=RelativeErrorsConfig(*numbers))


def test_photometric_stereo_has_the_scene_and_the_limits():
    assert build_cues(config("photometric_stereo", least_overlap=0.25), SCENE) == [
        PhotometricStereo(SCENE, PairLimits(None, 0.25))
    ]


def test_photometric_defocus_has_the_scene_and_its_two_images():
    assert build_cues(images(0.8, 0.5, 0.01), SCENE) == [PhotometricDefocus(SCENE, 0.8, 0.5, 0.01)]


def test_the_printed_form_has_its_relative_errors():
    assert build_cues(errors(0.01, 0.02, 0.03), SCENE) == [PrintedDefocus(0.01, 0.02, 0.03)]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (config(), "cues.names must be at least one of .*, each once, got none"),
        (config("stereo", "stereo"), "cues.names must be at least one of .*, each once, got stereo, stereo"),
        (config("limited_stereo", max_disparity=0.0), "cues.limits.max_disparity must be > 0 mm and finite, .* got 0"),
        (config("limited_stereo", least_overlap=1.0), "cues.limits.least_overlap must be >= 0 and < 1, got 1"),
        (config("stereo", least_overlap=0.5), "cues.limits are for limited_stereo, .* got cues.names of stereo"),
        (
            CuesConfig([CueName["stereo"]], two_images=TwoImagesConfig(1.0)),
            "cues.two_images are for photometric_defocus, got cues.names of stereo, which have none",
        ),
        (
            CuesConfig([CueName["stereo"]], relative_errors=RelativeErrorsConfig(change=0.1)),
            "cues.relative_errors are for printed_defocus, got cues.names of stereo, which have none",
        ),
        (images(), "cues.two_images.power_change_dioptres must be set for photometric_defocus, got null"),
        (images(-1.0), "cues.two_images: power_change_dioptres must be > 0 and finite, got -1"),
        (images(1.0, 2.0), "cues.two_images: light_share must be > 0 and <= 1, got 2"),
        (images(1.0, 1.0, -1.0), "cues.two_images: frequency_error must be >= 0 and finite, got -1"),
        (errors(), "cues.relative_errors.change must be set for printed_defocus, got null"),
        (errors(-1.0, 0.0, 0.1), "cues.relative_errors: frequency must be >= 0 and finite, got -1"),
        (errors(0.0, -1.0, 0.1), "cues.relative_errors: amplitude must be >= 0 and finite, got -1"),
        (errors(0.0, 0.0, 0.0), "cues.relative_errors: change must be > 0 and finite, got 0"),
    ],
)
def test_what_does_not_go_together_is_refused(given, message):
    with pytest.raises(RefusedError, match=message):
        check_cues(given)
