"""A polygon of few edges in place of a shape: on the safe side, as near as it says, and as shapely sees it."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from multilens.geometry.shape import Shape, disc, polygon, rectangle
from multilens.geometry.simplify import few_edges

TOLERANCE = 0.05
"""mm; on shapes of about 100 mm."""

ROUNDING = 1e-9
"""mm; shapely's buffers and unions of coordinates of some 100 mm."""

FINE = 256
"""Edges of a quarter of a circle: as an oracle for arcs, off by 2e-5 of the radius."""


def many_edged(count: int = 500) -> Shape:
    """A wavy ring with notches, of many edges."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    reach = 40 + 5 * np.sin(7 * angle)
    return polygon(list(zip((reach * np.cos(angle)).tolist(), (reach * np.sin(angle)).tolist(), strict=True)))


def drawn(shape: Shape) -> BaseGeometry:
    return shape.polygon(FINE)


@pytest.mark.parametrize("within", [True, False], ids=["outline", "keep-out"])
@pytest.mark.parametrize(
    "shape",
    [disc((3.0, 4.0), 5.0), rectangle(30, 10), polygon([(0, 0), (30, 0), (30, 12), (14, 12), (14, 30), (0, 30)])],
    ids=["disc", "rectangle", "corners"],
)
def test_what_is_simple_stays(shape: Shape, within: bool) -> None:
    assert few_edges(shape, within, TOLERANCE) is shape


def test_a_keep_out_with_round_corners_keeps_them() -> None:
    shape = rectangle(30, 10, corner=3.0)
    assert few_edges(shape, False, TOLERANCE) is shape


@pytest.mark.parametrize("corner", [0.5, 3.0, 4.9])
def test_round_corners_of_an_outline_are_cut_inside(corner: float) -> None:
    shape = rectangle(30, 10, corner=corner)
    cut = few_edges(shape, True, TOLERANCE)
    assert cut.radius == 0
    assert drawn(shape).buffer(ROUNDING).covers(cut.core)


def test_cutting_round_corners_moves_the_rim_by_half_a_percent_of_the_radius_at_most() -> None:
    cut = few_edges(rectangle(30, 20, corner=8.0), True, TOLERANCE)
    assert cut.core.hausdorff_distance(drawn(rectangle(30, 20, corner=8.0))) < 0.005 * 8


def test_an_outline_of_many_edges_gets_smaller() -> None:
    shape = many_edged()
    assert shape.core.buffer(ROUNDING).covers(few_edges(shape, True, TOLERANCE).core)


def test_a_keep_out_of_many_edges_gets_larger() -> None:
    shape = many_edged()
    assert few_edges(shape, False, TOLERANCE).core.buffer(ROUNDING).covers(shape.core)


@given(st.integers(0, 2**31), st.booleans(), st.floats(1e-3, 0.5))
def test_any_region_stays_on_the_safe_side(
    random_region: Callable[[int], Polygon], seed: int, within: bool, tolerance: float
) -> None:
    # Every edge in parts of 2 mm, so that there are many.
    shape = Shape(random_region(seed).segmentize(2.0))
    simple = few_edges(shape, within, tolerance).core
    inner, outer = (simple, shape.core) if within else (shape.core, simple)
    assert outer.buffer(ROUNDING).covers(inner)


@pytest.mark.parametrize("within", [True, False], ids=["outline", "keep-out"])
def test_the_rim_moves_by_twice_the_tolerance_at_most(within: bool) -> None:
    # Once to the safe side and once more where points are dropped; a mitre goes farther only at corners sharper than these.
    shape = many_edged()
    simple = few_edges(shape, within, TOLERANCE)
    assert simple.core.boundary.hausdorff_distance(shape.core.boundary) < 2.1 * TOLERANCE


@pytest.mark.parametrize("count", [200, 2000, 20_000])
def test_the_number_of_edges_does_not_grow_with_the_outline(count: int) -> None:
    # Its tightest bends have a radius of about 12 mm: there a chord of 2 mm sags by the tolerance. The rim is 330 mm long.
    assert len(few_edges(many_edged(count), True, TOLERANCE).segments) <= 330 / 2


def test_a_round_keep_out_of_many_edges_keeps_its_radius() -> None:
    core = many_edged()
    shape = Shape(core.core, 1.5)
    simple = few_edges(shape, False, TOLERANCE)
    assert simple.radius == 1.5
    assert drawn(simple).buffer(1e-3).covers(drawn(shape))


def test_a_line_grown_by_a_radius_stays() -> None:
    shape = Shape(LineString([(0, 0), (10, 0)]), 2.0)
    assert few_edges(shape, True, TOLERANCE) is shape


def test_an_outline_thinner_than_the_tolerance_stays() -> None:
    thin = Shape(LineString([(0, 0), (100, 0)]).buffer(TOLERANCE / 2, quad_segs=40))
    assert few_edges(thin, True, TOLERANCE) is thin


def test_holes_of_an_outline_do_not_get_smaller() -> None:
    outline = Shape(many_edged().core.difference(Point(0, 0).buffer(10, quad_segs=100)))
    simple = few_edges(outline, True, TOLERANCE).core
    assert simple.intersection(Point(0, 0).buffer(10 - ROUNDING, quad_segs=100)).area == 0
