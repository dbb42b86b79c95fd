"""Distances to many edges against shapely, and against closed forms where there are more edges than it would care for."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, MultiPolygon, Point, box

from multilens.geometry.nearest import distance_to_nearest
from multilens.geometry.shape import Shape

ROUNDING = 1e-11
"""mm; coordinates are about 100 mm."""


def rim_of(corners: np.ndarray) -> np.ndarray:
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def by_shapely(points: np.ndarray, segments: np.ndarray) -> np.ndarray:
    return np.asarray(shapely.distance(shapely.points(points), MultiLineString(list(segments))))


def around(segments: np.ndarray, seed: int, count: int) -> np.ndarray:
    low, high = segments.min((0, 1)), segments.max((0, 1))
    return np.random.default_rng(seed).uniform(low - (high - low) / 4, high + (high - low) / 4, (count, 2))


@given(st.integers(0, 2**31))
def test_regions_with_holes_and_parts(random_region, seed):
    segments = Shape(random_region(seed)).segments
    points = around(segments, seed, 50)
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), by_shapely(points, segments), rtol=0, atol=ROUNDING
    )


@given(st.integers(0, 2**31), st.integers(3, 300))
def test_rims_as_rough_as_can_be(seed, corners):
    # Corners anywhere, edges that cross: no run is near its chord.
    segments = rim_of(np.random.default_rng(seed).uniform(-50, 50, (corners, 2)))
    points = around(segments, seed, 50)
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), by_shapely(points, segments), rtol=0, atol=ROUNDING
    )


@given(st.integers(0, 2**31))
def test_smooth_rims(seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, 600))
    radius = 30 * (1 + 0.3 * np.cos(random.integers(2, 12) * angle))
    segments = rim_of(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1))
    points = around(segments, seed, 50)
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), by_shapely(points, segments), rtol=0, atol=ROUNDING
    )


def test_many_small_rings():
    squares = [box(4 * i, 4 * j, 4 * i + 1, 4 * j + 2) for i in range(12) for j in range(12)]
    segments = Shape(MultiPolygon(squares)).segments
    points = around(segments, 0, 200)
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), by_shapely(points, segments), rtol=0, atol=ROUNDING
    )


def test_the_middle_of_a_rim_as_far_from_every_edge():
    angle = np.arange(1000) * 2 * np.pi / 1000
    segments = rim_of(25 * np.stack([np.cos(angle), np.sin(angle)], axis=-1))
    assert distance_to_nearest(np.zeros((1, 2)), segments) == pytest.approx(25 * np.cos(np.pi / 1000), abs=ROUNDING)


def test_from_far_off_a_disc_of_many_edges_is_a_disc():
    angle = np.arange(2000) * 2 * np.pi / 2000
    segments = rim_of(np.stack([np.cos(angle), np.sin(angle)], axis=-1))
    points = np.random.default_rng(0).uniform(100, 900, (50, 2))
    # The polygon lies within 1 - cos(pi / 2000) of its disc.
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), np.hypot(*points.T) - 1, rtol=0, atol=(np.pi / 2000) ** 2
    )


def test_what_a_point_is_told_does_not_depend_on_the_others():
    angle = np.arange(300) * 2 * np.pi / 300
    segments = rim_of(np.stack([30 * np.cos(angle), 20 * np.sin(angle)], axis=-1))
    points = around(segments, 0, 9000)
    together = distance_to_nearest(points, segments)
    assert np.array_equal(together[8990:], distance_to_nearest(points[8990:], segments))


def test_points_on_the_rim_are_at_no_distance():
    segments = rim_of(np.random.default_rng(0).uniform(-50, 50, (100, 2)))
    assert distance_to_nearest(segments[:, 0], segments).max() == 0


@pytest.mark.parametrize("edges", [1, 100])
def test_edges_without_length_are_points(edges):
    segments = np.zeros((edges, 2, 2))
    assert distance_to_nearest(np.array([[3.0, 4.0]]), segments).tolist() == [5.0]


def test_lengths_whose_squares_underflow():
    segments = rim_of(np.random.default_rng(0).uniform(-1e-160, 1e-160, (30, 2)))
    assert distance_to_nearest(np.array([[3.0, 4.0]]), segments).tolist() == [5.0]


@pytest.mark.parametrize("core", [Point(1, 2), LineString([(0, 0), (10, 0), (10, 5)])], ids=["point", "line"])
def test_cores_without_area(core):
    segments = Shape(core, 1.0).segments
    points = around(segments + np.array([0.0, 1.0]), 0, 50)
    np.testing.assert_allclose(
        distance_to_nearest(points, segments), shapely.distance(shapely.points(points), core), rtol=0, atol=ROUNDING
    )


@pytest.mark.parametrize("edges", [4, 100])
def test_no_points_have_no_distances(edges):
    assert len(distance_to_nearest(np.zeros((0, 2)), np.zeros((edges, 2, 2)))) == 0
