"""Shared areas and their shape derivatives against closed forms, shapely and finite differences.

A disc is taken as a regular polygon of its own area, which lies between the disc's own circle made smaller and made larger by
known factors. Areas can only grow with their discs, so every closed form at the two gives a bracket, not a guessed tolerance.
"""

from math import acos, cos, pi, sin, sqrt

import numpy as np
import pytest
import shapely
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, box
from torch.autograd import grad, gradcheck

from multilens.geometry import overlap
from multilens.geometry.overlap import EDGES, outside_area, overlap_area, regular_polygon

OUTER = sqrt(2 * pi / (EDGES * sin(2 * pi / EDGES)))
INNER = OUTER * cos(pi / EDGES)
ROUNDING = 1e-9
"""mm^2; shapely's overlays of discs of some 10 mm."""

HALF_PLANE = box(-1000, -1000, 0, 1000)


def tensors(*numbers: object) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64).requires_grad_() for number in numbers]


def lens_area(distance: float, first: float, second: float) -> float:
    """Area that two discs share, in closed form."""
    if distance >= first + second:
        return 0.0
    if distance <= abs(first - second):
        return pi * min(first, second) ** 2
    at_first, at_second = half_angles(distance, first, second)
    kite = first * distance * sin(at_first)
    return first**2 * at_first + second**2 * at_second - kite


def half_angles(distance: float, first: float, second: float) -> tuple[float, float]:
    """Half of the angle under which each centre sees the chord that two circles share."""
    cosine = (distance**2 + first**2 - second**2) / (2 * distance * first)
    other = (distance**2 + second**2 - first**2) / (2 * distance * second)
    return acos(cosine), acos(other)


def segment_area(radius: float, inside: float) -> float:
    """Area of a disc beyond a line at the distance `inside` from its centre, towards which it is cut."""
    share = min(max(inside / radius, -1), 1)
    return radius**2 * (acos(share) - share * sqrt(1 - share**2))


@given(st.floats(0.0, 25.0), st.floats(0.5, 10.0), st.floats(0.5, 10.0), st.floats(0, 2 * pi))
def test_area_of_two_discs_is_the_closed_form(distance, first, second, angle):
    place = (distance * cos(angle), distance * sin(angle))
    area = overlap_area(*tensors((0.0, 0.0), first, place, second)).item()
    smaller, larger = (lens_area(distance, first * by, second * by) for by in (INNER, OUTER))
    assert smaller - ROUNDING <= area <= larger + ROUNDING


@pytest.mark.parametrize("distance", [4.0, 7.0, 12.0])
def test_error_falls_with_the_square_of_the_number_of_edges(monkeypatch, distance):
    def mean_error(edges: int) -> float:
        corner, inner = regular_polygon(edges)
        monkeypatch.setattr(overlap, "_CORNER", corner)
        monkeypatch.setattr(overlap, "_EDGE_PER_RADIUS", inner)
        angle = torch.linspace(0, 1, 24, dtype=torch.float64)
        place = distance * torch.stack([angle.cos(), angle.sin()], dim=-1)
        radii = torch.full((24,), 6.0, dtype=torch.float64), torch.full((24,), 7.0, dtype=torch.float64)
        area = overlap_area(torch.zeros(24, 2, dtype=torch.float64), radii[0], place, radii[1])
        return (area - lens_area(distance, 6.0, 7.0)).abs().mean().item()

    # A sixteenth for four times the edges, and half of that for how the corners happen to lie.
    assert mean_error(256) < mean_error(64) / 8


@pytest.mark.parametrize(("first", "second", "distance"), [(6.0, 7.0, 4.0), (5.0, 5.0, 8.0), (3.0, 9.0, 7.0)])
def test_gradient_in_the_centres_is_the_chord(first, second, distance):
    discs = tensors((1.0, 2.0), first, (1.0 + distance * 0.6, 2.0 + distance * 0.8), second)
    towards, _, away, _ = grad(overlap_area(*discs), discs)
    at_first, _ = half_angles(distance, first, second)
    chord = 2 * first * sin(at_first)
    # The chord's ends lie within 2e-4 radii of the circles, along which they move up to five times as far where the circles
    # cross at a flat angle.
    expected = chord * torch.tensor([0.6, 0.8], dtype=torch.float64)
    torch.testing.assert_close(towards, expected, rtol=0, atol=2e-3 * max(first, second))
    torch.testing.assert_close(away, -expected, rtol=0, atol=2e-3 * max(first, second))


@pytest.mark.parametrize(("first", "second", "distance"), [(6.0, 7.0, 4.0), (5.0, 5.0, 8.0), (3.0, 9.0, 7.0)])
def test_gradient_in_the_radii_is_the_arc_inside_the_other(first, second, distance):
    discs = tensors((1.0, 2.0), first, (1.0 + distance * 0.6, 2.0 + distance * 0.8), second)
    _, of_first, _, of_second = grad(overlap_area(*discs), discs)
    at_first, at_second = half_angles(distance, first, second)
    assert of_first.item() == pytest.approx(2 * first * at_first, abs=2e-3 * max(first, second))
    assert of_second.item() == pytest.approx(2 * second * at_second, abs=2e-3 * max(first, second))


@pytest.mark.parametrize("distance", [0.0, 1.0], ids=["concentric", "off centre"])
def test_a_disc_inside_another_shares_all_of_its_area(distance):
    discs = tensors((0.0, 0.0), 5.0, (distance, 0.0), 2.0)
    area = overlap_area(*discs)
    slopes = grad(area, discs)
    assert area.item() == pytest.approx(pi * 2**2)
    assert slopes[3].item() == pytest.approx(2 * pi * 2)
    assert torch.cat([slopes[0], slopes[1][None], slopes[2]]).abs().max() < ROUNDING


def test_discs_that_are_apart_share_nothing_and_have_no_gradient():
    discs = tensors((0.0, 0.0), 5.0, (11.0, 0.0), 5.0)
    area = overlap_area(*discs)
    assert area.item() == 0
    assert all((slope == 0).all() for slope in grad(area, discs))


def test_equal_discs_in_one_place_have_a_finite_gradient():
    discs = tensors((1.0, 1.0), 5.0, (1.0, 1.0), 5.0)
    area = overlap_area(*discs)
    assert area.item() == pytest.approx(pi * 5**2)
    assert all(slope.isfinite().all() for slope in grad(area, discs))


def test_overlap_agrees_with_finite_differences():
    discs = tensors(
        [[0.0, 0.0], [3.0, 1.0], [0.0, 0.0], [9.0, 9.0]],
        [5.0, 2.0, 1.0, 3.0],
        [[4.1, 2.3], [3.4, 1.2], [40.0, 0.0], [5.2, 6.9]],
        [4.0, 5.0, 2.0, 3.0],
    )
    assert gradcheck(overlap_area, discs)


@pytest.mark.parametrize("batch", [(0,), (2, 0), (2, 3)], ids=str)
def test_batches_of_any_shape_also_empty(batch):
    centre, radius = torch.zeros(*batch, 2), torch.ones(batch)
    assert overlap_area(centre, radius, centre + 1, radius).shape == batch
    assert outside_area(centre, radius, HALF_PLANE).shape == batch


def test_single_precision_stays_single():
    centre = torch.zeros(1, 2, requires_grad=True)
    area = overlap_area(centre, torch.ones(1), centre + 1, torch.ones(1))
    assert area.dtype == torch.float32


@given(st.floats(-12.0, 12.0), st.floats(0.5, 10.0), st.floats(-50.0, 50.0))
def test_area_beyond_a_line_is_the_closed_form(inside, radius, along):
    area = outside_area(*tensors((-inside, along), radius), HALF_PLANE).item()
    smaller, larger = (segment_area(radius * by, inside) for by in (INNER, OUTER))
    assert smaller - ROUNDING <= area <= larger + ROUNDING


@pytest.mark.parametrize("inside", [-3.0, 0.5, 3.0])
def test_gradient_beyond_a_line_is_its_chord_and_arc(inside):
    centre, radius = tensors((-inside, 4.0), 5.0)
    of_centre, of_radius = grad(outside_area(centre, radius, HALF_PLANE), (centre, radius))
    chord, arc = 2 * sqrt(5.0**2 - inside**2), 2 * 5.0 * acos(inside / 5.0)
    torch.testing.assert_close(of_centre, torch.tensor([chord, 0.0]).double(), rtol=0, atol=5e-3)
    assert of_radius.item() == pytest.approx(arc, abs=5e-3)


@given(st.integers(0, 2**31))
def test_area_outside_a_region_agrees_with_shapely(random_region, seed):
    region = random_region(seed)
    random = np.random.default_rng(seed)
    centre, radius = random.uniform(-60, 60, (6, 2)), random.uniform(1, 15, 6)
    area = outside_area(torch.from_numpy(centre), torch.from_numpy(radius), region).numpy()
    # Shapely's own discs, of 1,200 edges: just inside and, less than a millionth added, just outside the polygon that stands
    # for the disc.
    discs = shapely.buffer(
        shapely.points(centre), np.stack([radius * INNER, radius * OUTER * (1 + 1e-6)]), quad_segs=300
    )
    low, high = shapely.area(shapely.difference(discs, region))
    assert (low - ROUNDING <= area).all()
    assert (area <= high + ROUNDING).all()


@given(st.integers(0, 2**31))
def test_what_is_outside_and_what_is_inside_is_the_whole_disc(random_region, seed):
    region = random_region(seed)
    centre, radius = torch.tensor([[5.0, -8.0]]).double(), torch.tensor([20.0]).double()
    everything = box(-200, -200, 200, 200)
    inside = outside_area(centre, radius, everything.difference(region))
    total = outside_area(centre, radius, region) + inside
    assert total.item() == pytest.approx(pi * 20.0**2, rel=1e-12)


def test_outside_agrees_with_finite_differences():
    region = box(0, 0, 30, 20).difference(Point(15, 8).buffer(3)).union(box(40, 0, 50, 20))
    centre, radius = tensors(
        [[2.0, 3.1], [14.2, 9.7], [28.9, 18.7], [35.3, 9.1], [20.0, 10.0], [80.0, 0.0]], [4.0, 2.0, 3.0, 9.0, 1.0, 2.0]
    )
    assert gradcheck(lambda c, r: outside_area(c, r, region), (centre, radius))


def test_a_disc_inside_the_region_has_no_area_outside_and_no_gradient():
    centre, radius = tensors((-20.0, 0.0), 5.0)
    area = outside_area(centre, radius, HALF_PLANE)
    assert area.item() == 0
    assert all((slope == 0).all() for slope in grad(area, (centre, radius)))
