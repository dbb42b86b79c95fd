from dataclasses import replace
from math import hypot

import pytest
import torch

import multilens as ml
from multilens.layout import Layout
from multilens.search.limits import Limits
from multilens.search.sketch import sketch
from multilens.search.starts import tried_places

LENS = ml.Lens(6.0, (0.5, 2.0), (200.0, 5000.0), clearance=4.0, disparity_noise=2e-4, blur_noise=2e-4)


def drawn(problem: ml.Problem | ml.ScoreProblem) -> Layout | None:
    return sketch(problem, *tried_places(problem.back, 0))


def asked(lenses: list[ml.Lens], back: ml.Back | None = None) -> ml.Problem:
    return ml.Problem(back or ml.Back.rectangle(70, 150), lenses, ml.log_depths(200, 5000, 16))


def test_two_of_the_lenses_stand_in_opposite_corners_as_wide_as_they_may_be() -> None:
    layout = drawn(asked([LENS] * 4))
    assert layout is not None
    baselines = (layout.position.unsqueeze(0) - layout.position.unsqueeze(1)).norm(dim=-1)
    assert baselines.max().item() == pytest.approx(hypot(70 - 2 * 6, 150 - 2 * 6), rel=1e-12)
    assert (layout.aperture_radius == 2.0).all()


def test_it_is_feasible_where_there_is_room() -> None:
    back = ml.Back.rounded_rectangle(70, 150, 12).keep_out("logo", ml.disc((35.0, 75.0), 20.0), clearance=1.0)
    problem = asked([LENS] * 6, back)
    layout = drawn(problem)
    assert layout is not None
    assert Limits(problem)(layout).least > -1e-9


def test_the_baseline_is_that_of_the_lenses_that_measure_best_by_stereo() -> None:
    noisy = replace(LENS, disparity_noise=1e-3)
    layout = drawn(asked([noisy, LENS, noisy, LENS]))
    assert layout is not None
    assert (layout.position[1] - layout.position[3]).norm().item() == pytest.approx(hypot(58, 138), rel=1e-12)


def test_a_narrow_body_that_reaches_farther_ends_the_baseline() -> None:
    layout = drawn(asked([LENS, replace(LENS, clearance=1.0), LENS, replace(LENS, clearance=1.0)]))
    assert layout is not None
    assert (layout.position[1] - layout.position[3]).norm().item() == pytest.approx(hypot(64, 144), rel=1e-12)


def test_a_lens_by_itself_stands_where_it_may_be_as_wide_as_it_can() -> None:
    problem = asked([LENS], ml.Back.rectangle(30, 40).keep_out("wide", ml.rectangle(30, 27)))
    layout = drawn(problem)
    assert layout is not None
    assert (layout.aperture_radius == 2.0).all()
    assert Limits(problem)(layout).least > 0


@pytest.mark.parametrize(
    "problem",
    [
        asked([LENS, replace(LENS, position=(10.0, 10.0))]),
        asked([LENS] * 2, ml.Back.disc(7)),
        ml.ScoreProblem(ml.Back.rectangle(70, 150), [LENS] * 2, lambda layout: layout.aperture_radius),
    ],
    ids=["a lens has its place", "no two fit", "a score of one's own"],
)
def test_nothing_is_drawn_where_it_would_mean_nothing(problem: ml.Problem) -> None:
    assert drawn(problem) is None


def test_every_tier_has_a_focus_within_the_range() -> None:
    layout = drawn(asked([replace(LENS, tiers=2), LENS]))
    assert layout is not None
    assert torch.equal(layout.focus, torch.full((2, 2), 5000.0, dtype=torch.float64))
