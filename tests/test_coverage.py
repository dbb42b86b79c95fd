"""Coverage against hand-worked depths and angles."""

from dataclasses import replace

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from multilens import Back, Field, Layout, Lens, LimitedStereo, PairLimits, Problem, evaluate
from multilens.coverage import coverage, coverage_in_words

BACK = Back.rectangle(100, 100)
WIDE, TELE = Lens(6.0, (0.5, 3.0), field_of_view_deg=80.0), Lens(6.0, (0.5, 3.0), field_of_view_deg=30.0)
STEREO = LimitedStereo(PairLimits(max_disparity=0.6))
FIELD = Field([0.0, 30.0, 50.0], [2.0, 1.0, 1.0])


def test_shares_are_of_depths_and_angles_together():
    # A parallax of 0.1: the two wide lenses, 90 mm apart, work from 900 mm on, both pairs with the tele lens from 500 mm.
    layout = Layout([(0, 0), (90, 0), (45, 0)], [1.0] * 3, [500.0] * 3)
    problem = Problem(BACK, [WIDE, WIDE, TELE], [400.0, 600.0, 1000.0], [1, 2, 5], [STEREO], field=FIELD)
    shares = {cover.measurement.label: cover.share for cover in coverage(problem, layout)}
    # At the centre nothing, 1-3 and 1-2; at 30 degrees nothing, nothing and 1-2; at 50 degrees no lens sees.
    expected = {"stereo 1-2": (0.5 + 0.25) * 5 / 8, "nothing": 0.5 / 8 + 0.25 * 3 / 8 + 0.25, "stereo 1-3": 0.5 * 2 / 8}
    assert list(shares) == ["stereo 1-2", "nothing", "stereo 1-3"]
    assert shares == pytest.approx(expected)


@given(st.integers(0, 50))
def test_what_is_not_measured_is_what_the_problem_says(seed):
    position = torch.rand(3, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(seed)) * 100
    layout = Layout(position, [1.0] * 3, [500.0] * 3)
    problem = Problem(BACK, [WIDE, WIDE, TELE], torch.linspace(100, 1000, 30), cues=[STEREO], field=FIELD)
    nothing = sum(cover.share for cover in coverage(problem, layout) if not cover.measurement.lenses)
    assert nothing == pytest.approx(1 - problem.measured(layout).item())


def test_without_a_field_it_is_of_the_depths():
    layout = Layout([(0, 0), (90, 0)], [1.0] * 2, [500.0] * 2)
    (cover,) = coverage(Problem(BACK, [WIDE, WIDE], [600.0, 1000.0], cues=[LimitedStereo()]), layout)
    assert (cover.measurement.label, cover.share) == ("stereo 1-2", 1.0)


def test_a_design_over_a_field_says_what_covers_it():
    fixed = {"aperture_radius": (1.0, 1.0), "focus": (500.0, 500.0)}
    lenses = [replace(WIDE, position=place, **fixed) for place in ((2.0, 2.0), (92.0, 2.0))]
    problem = Problem(BACK, lenses, [600.0, 1000.0], cues=[STEREO], field=FIELD)
    # Half of the depths, three quarters of the field.
    assert "depths and field    nothing 62.5 %, stereo 1-2 37.5 %" in str(evaluate(problem)).splitlines()


def test_many_measurements_are_counted_where_they_are_not_told():
    layout = Layout([(10 * i, 0) for i in range(9)], [1.0] * 9, [500.0 + 50 * i for i in range(9)])
    words = coverage_in_words(Problem(BACK, [WIDE] * 9, torch.linspace(400, 1000, 200)), layout)
    assert words.endswith(" more")
    assert words.count("%") == 6
