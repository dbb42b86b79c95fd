from math import cos, sin, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon

from multilens.cad.curve import Curve, circle
from multilens.cad.rims import rims
from multilens.cad.shapes import grown_core, shape_of
from multilens.geometry.shape import Shape, disc, rectangle

QUARTER = sqrt(2) - 1


def straight(*points: tuple[float, float]) -> Curve:
    return Curve(np.array(points, dtype=float), np.zeros(len(points)))


def square(left: float, top: float, side: float) -> Curve:
    return straight((left, top), (left + side, top), (left + side, top + side), (left, top + side))


def wave(corners: int) -> Curve:
    """A ring of arcs that bulge in and out by turns, so that neither chords nor tangents alone are safe."""
    angle = 2 * np.pi * np.arange(corners) / corners
    return Curve(np.stack([20 * np.cos(angle), 20 * np.sin(angle)], axis=-1), 0.3 * (-1.0) ** np.arange(corners))


@pytest.mark.parametrize("shape", [disc((1, 2), 3), rectangle(30, 40, corner=7), rectangle(4, 20, corner=2)])
def test_a_rim_of_one_radius_is_exact(shape: Shape):
    assert shape_of(rims(shape), True, 0.01) == (shape, 0.0)


def test_straight_edges_stay_where_they_are():
    shape, moved = shape_of([square(0.1, 0.2, 30.3)], True, 1.0)
    assert moved == 0
    assert shape.core.equals(Polygon(square(0.1, 0.2, 30.3).points))


@pytest.mark.parametrize("within", [True, False])
@pytest.mark.parametrize("tolerance", [0.1, 0.01])
def test_arcs_that_cannot_be_exact_go_to_the_safe_side_by_no_more_than_the_tolerance(within: bool, tolerance: float):
    curve = wave(12)
    true = Polygon(curve.cut(1e-5))
    shape, moved = shape_of([curve], within, tolerance)
    assert moved == tolerance
    rim = shape.core
    assert true.contains(rim) if within else rim.contains(true)
    assert rim.exterior.hausdorff_distance(true.exterior) < 1.2 * tolerance


def test_a_hole_in_an_outline_grows_and_its_shell_shrinks():
    shape, _ = shape_of([circle((0, 0), 10), circle((0, 0), 3)], True, 0.01)
    (hole,) = shape.core.interiors
    x, y = np.asarray(hole.coords).T
    middles = np.hypot((x[1:] + x[:-1]) / 2, (y[1:] + y[:-1]) / 2)
    assert middles.min() >= 3
    assert np.hypot(*np.asarray(shape.core.exterior.coords).T).max() <= 10


def test_an_odd_number_of_rings_is_inside():
    shape, _ = shape_of([square(4, 4, 2), square(0, 0, 10), square(2, 2, 6), square(20, 0, 5)], True, 0.01)
    assert shape.area == pytest.approx(100 - 36 + 4 + 25)


def test_what_is_drawn_twice_counts_once():
    shape, _ = shape_of([square(0, 0, 10), square(0, 0, 10)], True, 0.01)
    assert shape.area == pytest.approx(100)


def test_a_ring_that_crosses_itself_is_refused_with_the_crossing():
    with pytest.raises(ValueError, match=r"Self-intersection\[5 5\]"):
        shape_of([straight((0, 0), (10, 10), (10, 0), (0, 10))], True, 0.01)


def test_rings_that_cross_each_other_are_refused():
    with pytest.raises(ValueError, match=r"must not cross itself"):
        shape_of([square(0, 0, 10), square(5, 5, 10)], True, 0.01)


def test_an_outline_thinner_than_the_tolerance_is_refused():
    sliver = Curve(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.001], [0.0, 0.001]]), np.array([0.0, 1.0, 0.0, 0.9]))
    with pytest.raises(ValueError, match="wider than the tolerance"):
        shape_of([sliver], True, 0.01)


def test_a_tolerance_that_asks_for_too_many_edges_is_refused():
    with pytest.raises(ValueError, match="at most 10000 edges"):
        shape_of([wave(12)], True, 1e-8)


@pytest.mark.parametrize(
    "curve",
    [
        wave(8),
        # Half a lens: its arcs have one radius and turn one way, but its corners are sharp.
        Curve(np.array([[0.0, 0.0], [10.0, 0.0]]), np.array([QUARTER, QUARTER])),
        # A rectangle with two of four corners round.
        Curve(
            np.array([[0.0, 0.0], [10, 0], [10, 8], [8, 10], [2, 10], [0, 8]]), np.array([0, 0, QUARTER, 0, QUARTER, 0])
        ),
    ],
)
def test_what_is_no_grown_core_is_not_taken_for_one(curve: Curve):
    assert grown_core(curve) is None


@given(st.floats(0.3, 6.2), st.floats(-50, 50), st.floats(0.5, 40))
def test_a_circle_is_one_however_it_is_divided(angle: float, place: float, radius: float):
    ends = np.array([[radius, 0.0], [radius * cos(angle), radius * sin(angle)]]) + place
    curve = Curve(ends, np.tan(np.array([angle, 2 * np.pi - angle]) / 4))
    found = grown_core(curve)
    assert found is not None
    assert found.core.distance(disc((place, place), 1).core) < 1e-6
    assert found.radius == pytest.approx(radius, abs=1e-6)
