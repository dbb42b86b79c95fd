from collections.abc import Callable

import pytest
import torch
from torch import Tensor

import multilens as ml
from multilens.search.parting import part
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

penalties = pytest.mark.parametrize("penalty", [ml.distance_penalty, ml.area_penalty], ids=["distance", "area"])


def starts_of(problem: ml.Problem, count: int) -> tuple[Variables, Tensor]:
    variables = Variables(problem)
    return variables, variables.spread(scattered_starts(problem, variables, count, seed=1))


@penalties
def test_less_is_missing(penalty: Callable) -> None:
    # Lenses that stand off the back as a whole are left out: an area tells them nothing.
    lenses = [ml.Lens(1.0, (0.5, 4.0))] * 6
    back = ml.Back.rectangle(30, 20).keep_out("flash", ml.disc((7.0, 9.0), 1.5), clearance=0.5)
    problem = ml.Problem(back, lenses, ml.log_depths(300, 2000, 8))
    variables, share = starts_of(problem, 12)
    price = penalty(problem)
    before, after = (price(variables.layout_of(each)) for each in (share, part(variables, price, share)))
    assert after.mean() < 0.2 * before.mean()


@penalties
def test_two_discs_that_overlap_part(penalty: Callable) -> None:
    lenses = [ml.Lens(1.0, (2.0, 2.0))] * 2
    problem = ml.ScoreProblem(ml.Back.rectangle(20, 10), lenses, lambda layout: -layout.aperture_radius)
    variables, price = Variables(problem), penalty(problem)
    share = variables.spread(variables.vector(ml.Layout([[[9.5, 5.0], [11.0, 5.2]]], [[2.0] * 2], [[1.0] * 2])))
    position = variables.layout_of(part(variables, price, share)).position[0]
    assert torch.pdist(position).item() > 3.9


@penalties
def test_what_lacks_nothing_stays_to_the_bit(penalty: Callable) -> None:
    lenses = [ml.Lens(1.0, (1.0, 3.0))] * 2
    problem = ml.ScoreProblem(ml.Back.rectangle(20, 10), lenses, lambda layout: -layout.aperture_radius)
    variables, price = Variables(problem), penalty(problem)
    layouts = ml.Layout([[[5.0, 5.0], [15.0, 5.0]], [[5.0, 5.0], [6.0, 5.0]]], [[2.0] * 2] * 2, [[[1.0]] * 2] * 2)
    share = variables.spread(variables.vector(layouts))
    assert part(variables, price, share)[0].equal(share[0])


def test_what_is_locked_or_fixed_stays(crowded: ml.Problem) -> None:
    variables, share = starts_of(crowded, 6)
    free = torch.zeros(share.shape[1], dtype=torch.bool).index_fill(0, variables.free, True)
    parted = part(variables, ml.distance_penalty(crowded), share)
    assert parted[:, ~free].equal(share[:, ~free])


def test_foci_stay(crowded: ml.Problem) -> None:
    variables, share = starts_of(crowded, 6)
    parted = part(variables, ml.distance_penalty(crowded), share)
    assert parted[:, variables.focus_start :].equal(share[:, variables.focus_start :])


def test_unknowns_stay_within_their_bounds(crowded: ml.Problem) -> None:
    variables, share = starts_of(crowded, 12)
    x = part(variables, ml.distance_penalty(crowded), share)[:, variables.free]
    assert (x >= 0).all()
    assert (x <= variables.upper).all()


def test_a_price_without_a_finite_slope_moves_nothing(crowded: ml.Problem) -> None:
    variables, share = starts_of(crowded, 2)
    # The square root has no slope where nothing is left of it.
    parted = part(variables, lambda layout: 1 + (0 * layout.aperture_radius).sqrt().sum(-1), share)
    assert parted.equal(share)
