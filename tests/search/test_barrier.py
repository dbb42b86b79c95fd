from dataclasses import replace
from itertools import count
from math import sqrt

import pytest
import torch
from torch import Tensor

import multilens as ml
from multilens.search.barrier import BarrierSettings, Settled, settle
from multilens.search.sight import Seer
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

SETTINGS = BarrierSettings(steps=50, pressure=(0.1, 1e-7))


def circles(back: ml.Back, number: int) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, [ml.Lens(1.0, (0.01, 0.5))] * number, lambda layout: -layout.aperture_radius)


def settled(
    problem: ml.Problem | ml.ScoreProblem, starts: int, settings: BarrierSettings = SETTINGS
) -> tuple[Variables, Tensor, Settled]:
    variables = Variables(problem)
    share = variables.spread(scattered_starts(problem, variables, starts, seed=1))
    return variables, share, settle(Seer(problem, variables), share, settings)


def radius_of_least(variables: Variables, found: Settled) -> Tensor:
    return variables.layout_of(found.share).aperture_radius.amin(-1).where(found.feasible, 0)


def test_four_equal_circles_in_a_square() -> None:
    variables, _, found = settled(circles(ml.Back.rectangle(1, 1), 4), 16)
    assert radius_of_least(variables, found).max().item() == pytest.approx(0.25, abs=1e-5)


def test_three_equal_circles_in_a_disc() -> None:
    variables, _, found = settled(circles(ml.Back.disc(1.0), 3), 16)
    assert radius_of_least(variables, found).max().item() == pytest.approx(1 / (1 + 2 / sqrt(3)), abs=1e-5)


def test_the_best_focus_of_a_lens_in_closed_form() -> None:
    # The sum of w Z^2 (Z - Zf)^2 is least at Zf = sum w Z^3 / sum w Z^2.
    depths = ml.linear_depths(300, 900, 64)
    problem = ml.Problem(ml.Back.rectangle(9, 9), [ml.Lens(5.0, (1.0, 1.0))], depths, cues=[ml.LensDefocus()])
    variables, _, found = settled(problem, 4)
    foci = variables.layout_of(found.share).focus.flatten()
    best = (depths**3).sum() / (depths**2).sum()
    torch.testing.assert_close(foci, best.expand(4), rtol=1e-5, atol=0)


def test_the_farthest_pair_of_a_rectangle() -> None:
    problem = ml.Problem(
        ml.Back.rectangle(30, 40), [ml.Lens(5.0, (1.0, 1.0))] * 2, ml.linear_depths(300, 900, 8), cues=[ml.PairStereo()]
    )
    variables, _, found = settled(problem, 16)
    position = variables.layout_of(found.share).position[found.feasible]
    assert (position[:, 0] - position[:, 1]).norm(dim=-1).max().item() == pytest.approx(sqrt(28**2 + 38**2), rel=1e-5)


def test_what_is_locked_or_fixed_stays_to_the_bit(crowded: ml.Problem) -> None:
    lenses = (replace(crowded.lenses[0], position=(24.0, 6.0)), *crowded.lenses[1:])
    problem = ml.Problem(crowded.back, lenses, crowded.depths, crowded.weights, crowded.cues, crowded.gap)
    variables, share, found = settled(problem, 4)
    free = torch.zeros(share.shape[1], dtype=torch.bool).index_fill(0, variables.free, True)
    assert not free.all()
    assert found.share[:, ~free].equal(share[:, ~free])


def test_unknowns_stay_strictly_within_their_bounds(crowded: ml.Problem) -> None:
    variables, _, found = settled(crowded, 8)
    x = found.share[:, variables.free]
    assert (x > 0).all()
    assert (x < variables.upper).all()


def test_lenses_that_overlap_come_apart() -> None:
    problem = circles(ml.Back.rectangle(1, 1), 2)
    variables = Variables(problem)
    layout = ml.Layout([[[0.5, 0.5], [0.51, 0.5]]], [[0.3, 0.3]], [[1.0, 1.0]])
    found = settle(Seer(problem, variables), variables.spread(variables.vector(layout)), SETTINGS)
    assert found.feasible.item()
    # (2 - sqrt(2)) / 2, along a diagonal; straight on, a quarter: both are local optima.
    assert radius_of_least(variables, found).item() >= 0.25 - 1e-5


def test_a_lens_off_the_back_comes_inside() -> None:
    back = ml.Back(ml.polygon([(0, 0), (30, 0), (30, 12), (14, 12), (14, 30), (0, 30)]))
    problem = ml.ScoreProblem(back, [ml.Lens(1.0, (0.5, 2.0))], lambda layout: -layout.aperture_radius)
    variables = Variables(problem)
    # In the notch, nearest to its left side.
    outside = variables.spread(variables.vector(ml.Layout([[[17.0, 22.0]]], [[0.5]], [[1.0]])))
    found = settle(Seer(problem, variables), outside, SETTINGS)
    assert found.feasible.item()
    assert variables.layout_of(found.share).aperture_radius.item() == pytest.approx(2.0, rel=1e-5)


def test_missing_is_the_room_that_the_worst_limit_lacks() -> None:
    # Two discs of radius 3 need 12 mm of the 10 there are along a side, and (1 + 1 / sqrt(2)) 6 mm = 10.24 mm of the diagonal's.
    lenses = [ml.Lens(1.0, (3.0, 3.0))] * 2
    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), lenses, lambda layout: layout.position[..., 0, 0])
    _, _, found = settled(problem, 8)
    assert not found.feasible.any()
    # The least lack, shared by the pair and four edges, of every layout that there is: with less, radius 3 - lack / 2 would fit.
    assert (found.missing > 0.01 / (sqrt(200) / 4)).all()


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_a_start_does_the_same_alone_and_in_a_batch(crowded: ml.Problem, dtype: torch.dtype) -> None:
    exact, variables = Variables(crowded), Variables(crowded, dtype)
    share = exact.spread(scattered_starts(crowded, exact, 6, seed=3)).to(dtype)
    # A few steps: rounding grows from step to step, and in the end decides between optima.
    settings = BarrierSettings(steps=6, pressure=(0.1, 0.01))
    together = settle(Seer(crowded, variables), share, settings).share
    alone = torch.cat([settle(Seer(crowded, variables), each[None], settings).share for each in share])
    torch.testing.assert_close(together, alone, rtol=0, atol=1e5 * torch.finfo(dtype).eps)


def test_it_stops_when_it_is_told_to(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    share = variables.spread(scattered_starts(crowded, variables, 2, seed=1))
    asked = count()
    found = settle(Seer(crowded, variables), share, SETTINGS, lambda: next(asked) < 7)
    assert found.history.shape == (2, 8)


def test_the_history_begins_where_it_began_and_ends_where_it_ended(crowded: ml.Problem) -> None:
    variables, _, found = settled(crowded, 3)
    assert found.history.shape == (3, SETTINGS.steps + 1)
    torch.testing.assert_close(
        found.value, crowded.score(variables.layout_of(found.share)).log(), rtol=1e-12, atol=1e-12
    )
    assert found.history[:, -1].equal(found.value)


def test_a_start_that_meets_no_number_does_not_spoil_the_others() -> None:
    lens = ml.Lens(1.0, (0.5, 2.0))

    def score(layout: ml.Layout) -> Tensor:
        return torch.where(layout.position[..., 0, 0] > 5, torch.nan, -layout.aperture_radius[..., 0])

    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), [lens], score)
    variables = Variables(problem)
    layout = ml.Layout([[[2.5, 3.0]], [[7.5, 3.0]]], [[0.6], [0.6]], [[1.0], [1.0]])
    found = settle(Seer(problem, variables), variables.spread(variables.vector(layout)), SETTINGS)
    assert found.feasible.tolist() == [True, False]
    assert variables.layout_of(found.share).aperture_radius[0].item() == pytest.approx(2.0, rel=1e-4)
