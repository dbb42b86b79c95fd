from collections.abc import Callable
from math import pi

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, Polygon

import multilens as ml
from multilens.search.limits import Limits
from multilens.search.near_limits import CELLS, COARSE, DIRECTIONS, NearLimits


def asked(back: ml.Back, lenses: int) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, [ml.Lens(1.0, (0.5, 1.0))] * lenses, score=lambda layout: -layout.aperture_radius)


def at(points: np.ndarray) -> ml.Layout:
    return ml.Layout(torch.from_numpy(points), [0.5] * len(points), [1.0] * len(points))


def wavy(count: int) -> ml.Back:
    angle = np.linspace(0, 2 * pi, count, endpoint=False)
    reach = 40 + 4 * np.sin(5 * angle)
    return ml.Back(ml.polygon(list(zip(reach * np.cos(angle), reach * np.sin(angle), strict=True))))


def least(limits: Limits | NearLimits, points: np.ndarray) -> np.ndarray:
    return limits(at(points)).inside.amin(-1).numpy()


@given(st.integers(0, 2**31))
def test_on_a_back_of_few_edges_the_least_room_is_exact(random_region: Callable[[int], Polygon], seed: int) -> None:
    region = random_region(seed)
    if len(ml.Back(region).outline.segments) > 32:
        return
    problem = asked(ml.Back(region), 40)
    points = np.random.default_rng(seed).uniform(-80, 80, (40, 2))
    np.testing.assert_allclose(least(NearLimits(problem), points), least(Limits(problem), points), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "back",
    [
        ml.Back.disc(10.0).keep_out("flash", ml.disc((1.0, 0.0), 2.0), 0.25),
        ml.Back.rectangle(20, 10).keep_out("logo", ml.rectangle(4, 4, centre=(9, 5), corner=1.0), 0.5),
    ],
    ids=["discs", "a round keep-out"],
)
def test_round_rims_that_are_kept_are_exact(back: ml.Back) -> None:
    problem, points = asked(back, 100), np.random.default_rng(0).uniform(-12, 22, (100, 2))
    exact = least(Limits(problem), points)
    # Inside a keep-out and off the outline at once the way back leads over the nearest rim, whichever it is.
    sound = exact > -2
    np.testing.assert_allclose(least(NearLimits(problem), points)[sound], exact[sound], rtol=0, atol=1e-9)


def off_on_the_back(back: ml.Back) -> np.ndarray:
    """By how much the least room is too large, mm, at points all over the back."""
    problem, points = asked(back, 200), np.random.default_rng(1).uniform(-45, 45, (200, 2))
    exact = least(Limits(problem), points)
    return (least(NearLimits(problem), points) - exact)[exact > -0.5]


many_edges = pytest.mark.parametrize("back", [wavy(50), wavy(400), wavy(2000)], ids=["50", "400", "2000"])


@many_edges
def test_on_the_back_the_least_room_is_too_large_by_a_tenth_of_a_cell_at_most(back: ml.Back) -> None:
    # Edges are chosen from the middle of a cell: from its rim another may be a little nearer.
    left, _, right, _ = back.outline.bounds
    assert off_on_the_back(back).max() <= 0.1 * (right - left) / CELLS


@many_edges
def test_the_least_room_is_short_by_little(back: ml.Back) -> None:
    # Once for the safe side and once for the points that are left out.
    assert off_on_the_back(back).min() >= -2.1 * COARSE * back.size


def test_a_lens_off_a_back_of_many_edges_lacks_its_way_back() -> None:
    back = wavy(2000)
    problem, points = asked(back, 200), np.random.default_rng(2).uniform(-45, 45, (200, 2))
    off = np.array([not back.outline.core.covers(Point(*point)) for point in points])
    rim = np.array([back.outline.core.boundary.distance(Point(*point)) for point in points])
    found = least(NearLimits(problem), points)
    np.testing.assert_allclose(found[off], -rim[off] - 0.5, rtol=0, atol=2.1 * COARSE * back.size)


@pytest.mark.parametrize("count", [400, 2000, 10_000])
def test_a_lens_looks_at_as_many_edges_whatever_the_outline(count: int) -> None:
    assert NearLimits(asked(wavy(count), 3))(at(np.zeros((3, 2)))).inside.shape == (3, DIRECTIONS)


def test_ways_point_where_the_room_grows() -> None:
    limits, points = NearLimits(asked(wavy(400), 100)), np.random.default_rng(3).uniform(-30, 30, (100, 2))
    before, step = limits(at(points)), 1e-4
    worst = before.inside.argmin(-1)
    way = before.inward[torch.arange(100), worst].numpy()
    after = limits(at(points + step * way)).inside.gather(-1, worst.unsqueeze(-1)).squeeze(-1).numpy()
    # A step from one cell of the grid into the next would look at other edges: few of a hundred take one.
    grown = (after - before.inside.amin(-1).numpy()) / step
    assert np.isclose(grown, 1, atol=1e-4).mean() >= 0.98


def test_pairs_have_the_room_of_the_exact_limits(crowded: ml.Problem, generator: torch.Generator) -> None:
    position = 30 * torch.rand(20, 3, 2, generator=generator, dtype=torch.float64)
    layout = ml.Layout(position, torch.ones(20, 3).double(), torch.ones(20, 3, 2).double())
    near, exact = NearLimits(crowded)(layout), Limits(crowded)(layout)
    torch.testing.assert_close((near.apart, near.parting), (exact.apart, exact.parting), rtol=0, atol=1e-12)
