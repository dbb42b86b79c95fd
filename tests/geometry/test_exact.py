"""Sides of points: what floats leave out must change nothing, against every edge computed in fractions."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point, box

from multilens.geometry.exact import Side, exact, sides
from multilens.geometry.shape import Shape


def side_by_every_edge(segments: np.ndarray, point: tuple[float, float]) -> Side:
    """The definition, edge by edge: the least squared distance, and the parity of the edges crossed along x."""
    x, y = (Fraction(repr(number)) for number in point)
    squares, crossed = [], 0
    for edge in segments.reshape(-1, 4).tolist():
        x0, y0, x1, y1 = (Fraction(repr(number)) for number in edge)
        along_x, along_y = x1 - x0, y1 - y0
        length = along_x**2 + along_y**2
        share = ((x - x0) * along_x + (y - y0) * along_y) / length if length else Fraction(0)
        share = min(max(share, Fraction(0)), Fraction(1))
        squares.append((x - x0 - share * along_x) ** 2 + (y - y0 - share * along_y) ** 2)
        crossed += (y0 > y) != (y1 > y) and x < x0 + (y - y0) * along_x / along_y
    return Side(min(squares), crossed % 2 == 1)


def assert_sides_are_those_by_every_edge(segments: np.ndarray, points: np.ndarray) -> None:
    assert sides(segments, points) == [side_by_every_edge(segments, (x, y)) for x, y in points.tolist()]


def regular_polygon(corners: int, radius: float) -> np.ndarray:
    angle = np.arange(corners) * 2 * np.pi / corners
    corner = radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.stack([corner, np.roll(corner, -1, axis=0)], axis=1)


@given(st.integers(0, 2**31), st.sampled_from([0, 1, 3, 12]))
def test_points_about_a_region(random_region, seed, decimals):
    points = np.random.default_rng(seed).uniform(-60, 60, (8, 2)).round(decimals)
    assert_sides_are_those_by_every_edge(Shape(random_region(seed)).segments, points)


@given(st.integers(0, 2**31))
def test_points_as_near_to_the_rim_as_floats_can_be(random_region, seed):
    # Corners, middles of edges, and their neighbours among the floats.
    segments = Shape(random_region(seed)).segments
    on_rim = np.stack([segments[0, 0], segments[1].mean(0)])
    points = np.concatenate([on_rim, np.nextafter(on_rim, 100), np.nextafter(on_rim, -100)])
    assert_sides_are_those_by_every_edge(segments, points)


@given(st.lists(st.tuples(st.integers(-2, 12), st.integers(-2, 12)), min_size=1, max_size=5))
def test_points_level_with_corners_and_equally_far_from_several_edges(points):
    ring = box(0, 0, 10, 10).difference(box(2, 2, 4, 4)).difference(box(6, 6, 8, 8))
    assert_sides_are_those_by_every_edge(Shape(ring).segments, np.array(points, dtype=float))


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e-90, 1e-12, 1e4])
def test_shapes_of_any_size(scale):
    points = np.random.default_rng(0).uniform(-2, 2, (8, 2)) * scale
    assert_sides_are_those_by_every_edge(regular_polygon(5, scale), points)


@pytest.mark.parametrize("far", [1e7, 1e16, 1e154, 1.3e154, 1e302, 1.7e308])
def test_points_however_far(far):
    points = np.array([[far, 3.0], [3.0, -far], [far, far], [-far, 0.0], [-far, 1.0]])
    assert_sides_are_those_by_every_edge(regular_polygon(7, 20.0), points)


def test_the_middle_of_many_edges_that_differ_by_rounding_alone():
    middle = np.array([[0.0, 0.0], [1e-15, 0.0], [-1e-13, 1e-14], [1e-10, 0.0]])
    assert_sides_are_those_by_every_edge(regular_polygon(40, 25.0), middle)


@pytest.mark.parametrize("core", [Point(1, 2), LineString([(0, 0), (10, 0)])], ids=["point", "line"])
def test_cores_without_area_enclose_nothing(core):
    points = np.random.default_rng(0).uniform(-5, 15, (20, 2)).round(1)
    found = sides(Shape(core, 1.0).segments, points)
    assert [side.square for side in found] == [
        side_by_every_edge(Shape(core, 1.0).segments, (x, y)).square for x, y in points.tolist()
    ]
    assert not any(side.enclosed for side in found)


def test_three_four_five():
    segments = Shape(box(0, 0, 1, 1)).segments
    outside, inside = sides(segments, np.array([[1.3, 1.4], [0.5, 0.1]]))
    assert outside == Side(Fraction(1, 4), False)
    assert inside == Side(Fraction(1, 100), True)


def test_a_float_is_meant_as_its_shortest_decimal():
    assert exact(0.1) == Fraction(1, 10)
    assert exact(1e-7) == Fraction(1, 10**7)
    assert exact(-0.0) == 0


@pytest.mark.parametrize(("wild", "error"), [(float("nan"), ValueError), (float("inf"), OverflowError)])
def test_what_is_not_finite_is_refused(wild, error):
    with pytest.raises(error):
        exact(wild)
