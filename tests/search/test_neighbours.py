"""Layouts to begin with from the design of a neighbouring question."""

from dataclasses import replace
from math import hypot

import pytest
import torch

import multilens as ml
from multilens.certificate import certify
from multilens.search.evaluate import as_given
from multilens.search.neighbours import MOST_PLACES

LENS = ml.Lens(5.0, (0.5, 2.0), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)


def asked(count: int, back: ml.Back | None = None, lens: ml.Lens = LENS) -> ml.Problem:
    return ml.Problem(back or ml.Back.rectangle(60, 40), [lens] * count, ml.log_depths(300, 2000, 48))


def in_a_row(problem: ml.Problem) -> ml.Design:
    """Lenses beside each other, 8 mm apart, each with an aperture of its own."""
    count = len(problem.lenses)
    places = [[5.0 + 8 * index, 5.0] for index in range(count)]
    radii, foci = [1.0 + 0.1 * index for index in range(count)], [400.0 + 100 * index for index in range(count)]
    return as_given(problem, ml.Layout(places, radii, foci))


def feasible(problem: ml.Problem, layout: ml.Layout) -> bool:
    return certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap).feasible


def test_of_as_many_lenses_it_is_the_layout_itself() -> None:
    design = in_a_row(asked(3))
    (layout,) = ml.carried_over(replace(design.problem, depths=ml.log_depths(200, 900, 48)), design)
    assert layout.position.equal(design.layout.position)
    assert layout.focus.equal(design.layout.focus)


def test_on_a_larger_back_corners_are_carried_into_corners_too() -> None:
    problem = asked(2, ml.Back.disc(10.0))
    design = as_given(problem, ml.Layout([[-10.0, 0.0], [5.0, -10.0]], [1.0, 1.0], [400.0, 400.0]))
    itself, stretched = ml.carried_over(asked(2, ml.Back.rectangle(40, 60)), design)
    assert itself.position.equal(design.layout.position)
    assert stretched.position.tolist() == [[0.0, 30.0], [30.0, 0.0]]


def test_an_added_lens_leaves_the_others_alone_and_keeps_every_constraint() -> None:
    design, problem = in_a_row(asked(3)), asked(4)
    layouts = ml.carried_over(problem, design)
    assert len(layouts) == MOST_PLACES
    for layout in layouts:
        assert layout.only(range(3)).position.equal(design.layout.position)
        assert layout.aperture_radius.tolist() == [*design.layout.aperture_radius.tolist(), 0.5]
        assert feasible(problem, layout)


def test_an_added_lens_is_tried_far_and_near() -> None:
    layouts = ml.carried_over(asked(2), in_a_row(asked(1)))
    tried = torch.stack([layout.position[1] for layout in layouts])
    # Every corner that is left for a body of 2 mm, the points tried lying about 1.5 mm apart.
    for corner in ([2.0, 38.0], [58.0, 2.0], [58.0, 38.0]):
        assert (tried - torch.tensor(corner)).norm(dim=-1).min() < 4


def test_one_lens_more_never_scores_worse_where_there_is_room() -> None:
    design = ml.solve(asked(1), starts=1, patience=0, proof=0)
    for count in (2, 3, 4):
        problem = asked(count)
        more = ml.solve(problem, starts=0, patience=0, proof=0, known=ml.carried_over(problem, design))
        assert more.score <= design.score
        design = more


def test_where_a_lens_fits_only_if_others_give_way_they_give_way() -> None:
    # Two bodies of 3.5 mm fill the strip but for 2 mm; at their smallest, 2 mm each, there is room for a third.
    back = ml.Back.rectangle(16, 7)
    design = as_given(asked(2, back), ml.Layout([[3.5, 3.5], [12.5, 3.5]], [2.0, 2.0], [400.0, 500.0]))
    problem = asked(3, back)
    layouts = ml.carried_over(problem, design)
    assert layouts
    assert not any(feasible(problem, layout) for layout in layouts)
    assert ml.solve(problem, starts=0, patience=0, proof=0, known=layouts).feasible


def test_without_any_room_no_lens_is_added() -> None:
    back = ml.Back.rectangle(10, 4.5)
    design = as_given(asked(2, back), ml.Layout([[2.2, 2.2], [7.8, 2.2]], [0.5, 0.5], [400.0, 500.0]))
    assert ml.carried_over(asked(3, back), design) == ()


def test_each_lens_in_turn_is_left_out() -> None:
    design = in_a_row(asked(3))
    left = [layout.aperture_radius.tolist() for layout in ml.carried_over(asked(2), design)]
    assert left == [[1.1, 1.2], [1.0, 1.2], [1.0, 1.1]]


def test_a_lens_that_is_locked_is_added_in_its_place() -> None:
    locked = replace(LENS, position=(40.0, 30.0))
    problem = replace(asked(3), lenses=(LENS, locked, LENS))
    layouts = ml.carried_over(problem, in_a_row(asked(2)))
    assert {tuple(layout.position[1].tolist()) for layout in layouts} == {(40.0, 30.0)}
    assert all(layout.only([0, 2]).aperture_radius.tolist() == [1.0, 1.1] for layout in layouts)


def test_a_lens_of_more_tiers_is_added_with_as_many_foci() -> None:
    problem = replace(asked(2), lenses=(LENS, replace(LENS, tiers=3)))
    layout = ml.carried_over(problem, in_a_row(asked(1)))[0]
    assert layout.focus[0].tolist() == [400.0] * 3
    assert layout.focus[1].tolist() == pytest.approx([(300 * 2000) ** 0.5] * 3)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_lenses_of_other_tiers_carry_nothing_over(count: int) -> None:
    other = replace(LENS, tiers=2)
    assert ml.carried_over(asked(count), in_a_row(asked(2, lens=other))) == ()


def test_several_lenses_are_added_clear_of_each_other() -> None:
    problem = asked(5)
    layouts = ml.carried_over(problem, in_a_row(asked(2)))
    assert len(layouts) == MOST_PLACES
    assert all(feasible(problem, layout) for layout in layouts)


def test_two_lenses_less_carry_nothing_over() -> None:
    assert ml.carried_over(asked(2), in_a_row(asked(4))) == ()


def test_unlike_lenses_are_told_apart() -> None:
    # A tele is added before two main cameras: these keep their places and apertures.
    tele = replace(LENS, focal_length=15.0, aperture_radius=(2.0, 3.0))
    layout = ml.carried_over(replace(asked(3), lenses=(tele, LENS, LENS)), in_a_row(asked(2)))[0]
    assert layout.aperture_radius.tolist() == [2.0, 1.0, 1.1]


def test_a_score_of_ones_own_carries_over() -> None:
    def packing(count: int) -> ml.ScoreProblem:
        return ml.ScoreProblem(
            ml.Back.rectangle(1, 1), [ml.Lens(1.0, (0.01, 0.5))] * count, lambda at: -at.aperture_radius
        )

    four = ml.solve(packing(4), starts=8, patience=0)
    five = ml.solve(packing(5), starts=0, patience=0, known=ml.carried_over(packing(5), four))
    # The fifth circle in the hole between four that shrink: the published best.
    assert -five.score == pytest.approx((hypot(1, 1) - 1) / 2, abs=1e-9)
