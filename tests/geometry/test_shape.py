"""Shapes: the same answers for every tidy and untidy way of writing one, and one clear line for what is none."""

from math import cos, inf, nan, pi

import numpy as np
import pytest
import shapely
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiPolygon, Point, Polygon

from multilens.geometry.distance import signed_distance
from multilens.geometry.shape import LARGEST_COORDINATE, Shape, disc, polygon, rectangle

ROUNDING = 1e-11
"""mm; coordinates are about 100 mm."""

TRIANGLE = [(0.0, 0.0), (30.0, 0.0), (10.0, 20.0)]
SQUARE = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]


@pytest.mark.parametrize(
    "untidy",
    [
        [*TRIANGLE, TRIANGLE[0]],
        TRIANGLE[::-1],
        [TRIANGLE[0], *TRIANGLE, TRIANGLE[2]],
        [*TRIANGLE[1:], TRIANGLE[0]],
    ],
    ids=["closed", "clockwise", "doubled points", "another first point"],
)
def test_untidy_rings_make_the_same_shape(untidy):
    assert polygon(untidy) == polygon(TRIANGLE)


def test_a_hole_may_run_either_way():
    hole = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0)]
    assert Shape(Polygon(SQUARE, [hole])) == Shape(Polygon(SQUARE, [hole[::-1]]))


@pytest.mark.parametrize(
    ("points", "place"),
    [
        ([(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)], r"cross.*\[5 5\]"),
        ([(0.0, 0.0), (nan, 1.0), (1.0, 1.0)], "point 1 .*nan"),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, inf)], "point 2 .*inf"),
        ([(1e300, 0.0), (1.0, 0.0), (1.0, 1.0)], "point 0 .*1e[+]300"),
        ([(0.0, 0.0), (1.0, 0.0)], "at least 3 points, got 2"),
        ([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)], r"\[\d"),
    ],
    ids=["bowtie", "not a number", "infinite", "huge", "two points", "no area"],
)
def test_wild_polygons_are_refused_in_one_line_that_names_the_place(points, place):
    with pytest.raises(ValueError, match=place) as refused:
        polygon(points)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("core", "place"),
    [
        (Polygon(SQUARE, [[(20, 20), (21, 20), (21, 21)]]), r"[Hh]ole.*\[20 20\]"),
        (MultiPolygon([Polygon(SQUARE), Polygon([(5, 5), (15, 5), (15, 15), (5, 15)])]), r"\["),
        (Polygon(), "empty"),
        (MultiPolygon(), "empty"),
        (Point(0, 0), "area"),
        (LineString([(0, 0), (1, 0)]), "area"),
        (shapely.MultiPoint([(0, 0), (1, 0)]), "MultiPoint"),
    ],
    ids=["hole outside", "parts overlap", "empty", "no parts", "bare point", "bare line", "points"],
)
def test_geometries_that_are_no_shape_are_refused_in_one_line(core, place):
    with pytest.raises(ValueError, match=place) as refused:
        Shape(core)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("place", [1, 6], ids=["shell", "hole"])
@pytest.mark.parametrize("wild", [nan, inf, 1e300])
def test_a_wild_point_of_a_geometry_is_named(place, wild):
    tidy = Polygon(SQUARE, [[(2, 2), (4, 2), (4, 4)]])
    points = shapely.get_coordinates(tidy)
    points[place, 0] = wild
    with np.errstate(invalid="ignore"), pytest.raises(ValueError, match=f"point {place} must be finite"):
        Shape(shapely.set_coordinates(tidy, points))


@pytest.mark.parametrize("radius", [-1.0, nan, inf, 1e300])
def test_a_radius_out_of_range_is_refused(radius):
    with pytest.raises(ValueError, match="radius must be"):
        Shape(Point(0, 0), radius)


@pytest.mark.parametrize("length", [0.0, -1.0, nan, inf, 1e300])
def test_a_side_out_of_range_is_refused_by_name(length):
    with pytest.raises(ValueError, match="height must be"):
        rectangle(10.0, length)


@pytest.mark.parametrize("corner", [-1.0, 5.1, nan])
def test_a_corner_out_of_range_is_refused(corner):
    with pytest.raises(ValueError, match="corner must be from 0 to half the shorter side, 5 mm"):
        rectangle(10.0, 20.0, corner=corner)


def test_a_kilometre_is_still_accepted():
    assert rectangle(LARGEST_COORDINATE, 1.0).bounds == (0.0, 0.0, LARGEST_COORDINATE, 1.0)


@given(st.decimals(1, 200, places=2), st.decimals(1, 200, places=2), st.decimals(0, 1, places=3))
def test_edges_of_a_rounded_rectangle_are_the_decimals_one_would_write(width, height, share):
    corner = (share * min(width, height) / 2).quantize(share)
    if not 0 <= corner <= min(width, height) / 2:
        return
    core = rectangle(float(width), float(height), corner=float(corner)).core
    expected = tuple(float(end) for end in (corner, corner, width - corner, height - corner))
    assert core.bounds == expected


@pytest.mark.parametrize(
    ("corner", "kind"), [(0.0, "Polygon"), (4.0, "Polygon"), (5.0, "LineString")], ids=["sharp", "round", "a stadium"]
)
def test_a_rectangle_is_grown_from_what_its_corners_leave(corner, kind):
    shape = rectangle(10.0, 20.0, corner=corner)
    assert shape.core.geom_type == kind
    assert shape.bounds == (0.0, 0.0, 10.0, 20.0)


def test_a_square_with_the_roundest_corners_is_a_disc():
    assert rectangle(10.0, 10.0, centre=(3.0, 4.0), corner=5.0) == disc((3.0, 4.0), 5.0)


def test_area_of_a_rounded_rectangle():
    exact = 60 * 30 - (4 - pi) * 5**2
    # An inscribed polygon of 64 edges a quarter has 1 - (2 pi / 256)^2 / 6 of its disc's area.
    lost = pi * 5**2 * (2 * pi / 256) ** 2 / 6
    assert rectangle(60, 30, corner=5).polygon().area == pytest.approx(exact - lost, abs=lost * 0.01)


def test_arcs_are_cut_inside_the_shape():
    corners = shapely.get_coordinates(disc((0.0, 0.0), 10.0).polygon(16))
    assert np.linalg.norm(corners, axis=-1) == pytest.approx(10.0, rel=1e-12)


@given(st.integers(0, 2**31), st.sampled_from([0.0, 3.0]))
def test_indexed_distance_agrees_with_torch(random_region, seed, radius):
    shape = Shape(random_region(seed), radius)
    x, y = np.random.default_rng(seed).uniform(-90, 90, (2, 10, 20))
    point = torch.from_numpy(np.stack([x, y], axis=-1))
    expected = signed_distance(point, torch.from_numpy(shape.segments), radius)
    torch.testing.assert_close(torch.from_numpy(shape.signed_distance(x, y)), expected, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("core", [Point(1, 2), LineString([(0, 0), (10, 0), (10, 5)])], ids=["disc", "bent capsule"])
def test_indexed_distance_to_a_core_without_area_agrees_with_torch(core):
    shape = Shape(core, 4.0)
    x, y = np.random.default_rng(0).uniform(-20, 20, (2, 100))
    point = torch.from_numpy(np.stack([x, y], axis=-1))
    expected = signed_distance(point, torch.from_numpy(shape.segments), 4.0)
    torch.testing.assert_close(torch.from_numpy(shape.signed_distance(x, y)), expected, rtol=0, atol=ROUNDING)


@given(st.integers(0, 2**31))
def test_segments_are_all_the_edges_of_the_rim(random_region, seed):
    region = random_region(seed)
    length = np.linalg.norm(np.diff(Shape(region).segments, axis=1), axis=-1).sum()
    assert length == pytest.approx(region.length, rel=1e-12)


@given(st.integers(0, 2**31))
def test_segments_close_their_rings(random_region, seed):
    start, end = np.moveaxis(Shape(random_region(seed)).segments, 1, 0)
    assert sorted(map(tuple, start)) == sorted(map(tuple, end))


def test_bounds_of_a_turned_capsule():
    # A line of length 20 at 60 degrees to x, grown by 1.
    shape = Shape(LineString([(0, 0), (20 * cos(pi / 3), 20 * cos(pi / 6))]), 1.0)
    assert shape.bounds == pytest.approx((-1, -1, 11, 1 + 10 * 3**0.5))


@pytest.mark.parametrize("seed", range(60))
def test_a_shape_holds_its_shrunken_self_where_shapely_says_so(random_region, seed: int):
    whole = random_region(seed)
    shape = Shape(whole if seed % 3 else whole.convex_hull)
    # Corners that are hardly notched are no matter: shapely is asked with a little to spare, and so is the shape.
    copies = [shape.scaled(factor).core for factor in (0.999, 0.99, 0.9, 0.7, 0.4, 0.1)]
    within = all(shape.core.buffer(1e-6).contains(copy) for copy in copies)
    assert shape.holds_its_shrunken_self == within


@pytest.mark.parametrize(
    ("shape", "holds"),
    [
        (disc((3.0, 4.0), 2.0), True),
        (rectangle(10, 20, corner=3), True),
        (rectangle(10, 20, corner=5), True),
        (polygon([(0, 0), (9, 0), (9, 9), (5, 6), (0, 9)]), True),
        (polygon([(0, 0), (9, 0), (9, 9), (8, 9), (8, 1), (0, 1)]), False),
        (polygon(SQUARE, [[(4, 4), (6, 4), (6, 6), (4, 6)]]), False),
        (Shape(MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)])), False),
    ],
    ids=["disc", "rounded", "capsule", "shallow notch", "L", "hole", "parts"],
)
def test_plain_shapes_that_hold_their_shrunken_selves(shape: Shape, holds: bool):
    assert shape.holds_its_shrunken_self == holds


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (disc((3.0, 4.0), 2.0), 4 * pi),
        (rectangle(30.0, 20.0), 600.0),
        (rectangle(30.0, 20.0, corner=5.0), 600 - (4 - pi) * 25),
        (Shape(LineString([(0, 0), (10, 0)]), 2.0), 40 + 4 * pi),
        (Shape(Polygon([(0, 0), (9, 0), (9, 9), (0, 9)], [[(3, 3), (6, 3), (6, 6), (3, 6)]])), 72.0),
    ],
)
def test_the_area_is_that_of_the_closed_form(given, expected):
    assert given.area == pytest.approx(expected, rel=1e-12)


def test_the_area_of_a_grown_corner_counts_no_point_twice():
    # Two strips of 10 by 2 mm share a square; half a disc at each end, a quarter of one outside the bend.
    bent = Shape(LineString([(0, 0), (10, 0), (10, 10)]), 1.0)
    assert bent.area == pytest.approx(40 - 1 + pi + pi / 4, rel=1e-6)
