"""Numbers that no source gives are marked, and the marks are told."""

import pytest

from multilens.app.estimates import estimates, refuse_stray_estimates, told
from multilens.app.refusal import RefusedError
from multilens.app.schema import BackConfig, Config, LensConfig, LensesConfig
from multilens.app.schema_cues import CueName, CuesConfig


def marked() -> Config:
    lenses = [LensConfig(1.0, name="main", estimates={"clearance": "seen"}), LensConfig(2.0)]
    return Config(
        back=BackConfig(estimates={"outline.corner": "not published"}),
        lenses=LensesConfig(each=lenses, estimates={"places": "seen"}),
    )


def test_marks_are_found_by_their_whole_keys():
    assert list(estimates(marked())) == ["back.outline.corner", "lenses.places", "lenses.each.0.clearance"]


def test_what_the_user_sets_is_no_estimate_of_ours():
    assert list(estimates(marked(), ["lenses.places"])) == ["back.outline.corner", "lenses.each.0.clearance"]
    assert "back.outline.corner" not in estimates(marked(), ["back.outline"])


@pytest.mark.parametrize(("cue", "count"), [("stereo", 0), ("photometric_stereo", 1)])
def test_a_sensor_is_told_only_where_its_numbers_are_read(cue: str, count: int):
    lens = LensConfig(1.0, estimates={"sensor.full_well": "guessed"})
    config = Config(lenses=LensesConfig(count=2, lens=lens), cues=CuesConfig([CueName[cue]]))
    assert len(estimates(config)) == count


def test_a_preset_that_is_chosen_keeps_its_marks():
    assert len(estimates(marked(), ["back", "lenses", "depth"])) == 3


def test_keys_of_one_reason_share_a_line():
    assert told({"a.b": "seen", "c": "heard", "d": "seen"}).splitlines()[1:] == ["  a.b, d: seen", "  c: heard"]


def test_keys_that_differ_in_the_lens_alone_are_told_once():
    marks = {"lenses.each.0.focus": "seen", "lenses.each.2.focus": "seen", "lenses.each.1.clearance": "seen"}
    assert told(marks).splitlines()[1:] == ["  lenses.each.0,2.focus, lenses.each.1.clearance: seen"]


def test_nothing_is_told_where_all_is_known():
    assert told({}) == ""


def test_a_mark_on_nothing_is_refused():
    config = Config(back=BackConfig(estimates={"outline.cornre": "misspelt"}))
    with pytest.raises(RefusedError, match=r"back.estimates.outline.cornre must name a key"):
        refuse_stray_estimates(config)
