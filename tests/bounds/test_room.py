"""Room on the back against closed forms, and against points drawn at random from it."""

from math import hypot, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon, box, maximum_inscribed_circle

from multilens import Back, disc, polygon
from multilens.bounds.room import Reach, body_area, box_area, largest_body, most_apart
from multilens.constraints import room_at

TURN = 1e-4
"""Relative; what a distance is rounded up by for the directions between those that are measured."""

L = Back(polygon([(0, 0), (80, 0), (80, 30), (30, 30), (30, 80), (0, 80)]))


def farthest(back: Back, first: float, second: float) -> float:
    reach = [Reach.free(back, np.array([radius])).support for radius in (first, second)]
    return most_apart(*reach).item()


@pytest.mark.parametrize(
    ("back", "first", "second", "expected"),
    [
        (Back.disc(25), 3.0, 8.0, 39.0),
        (Back.rectangle(70, 150), 5.0, 5.0, hypot(60, 140)),
        (Back.rectangle(70, 150), 5.0, 20.0, hypot(45, 125)),
        (Back.rounded_rectangle(70, 150, 10), 2.0, 2.0, hypot(50, 130) + 16),
        (Back.rounded_rectangle(70, 150, 10), 12.0, 12.0, hypot(46, 126)),
    ],
)
def test_the_farthest_pair_has_its_closed_form(back, first, second, expected):
    assert expected <= farthest(back, first, second) <= expected * (1 + TURN)


def test_around_a_keep_out_centres_are_not_as_far_apart():
    # A keep-out in the corner: the farthest pair stands in the other two corners' diagonal, 20 x 20 less 2 on every side.
    back = Back.rectangle(20, 20).keep_out("a", box(0, 0, 8, 8)).keep_out("b", box(0, 12, 8, 20))
    # From (2, 10) or (10, 2) and (10, 18) to (18, 2) or (18, 18): the farthest are (18, 2) and (18, 18) from (2, 10), and (10, 2).
    expected = max(hypot(16, 8), hypot(8, 16))
    assert expected <= farthest(back, 2.0, 2.0) <= expected + 0.4


@settings(max_examples=8)
@given(st.integers(0, 2**31), st.floats(0.1, 10))
def test_no_two_places_are_farther_apart(random_region, seed, radius):
    back = Back(random_region(seed))
    left, top, right, bottom = back.outline.bounds
    random = np.random.default_rng(seed)
    x, y = random.uniform(left, right, 2000), random.uniform(top, bottom, 2000)
    free = room_at(back, x, y) >= radius
    places = np.stack([x, y], axis=1)[free]
    if len(places):
        apart = np.linalg.norm(places[:, None] - places, axis=-1).max()
        assert apart <= farthest(back, radius, radius)


@pytest.mark.parametrize(
    ("back", "expected"),
    [(Back.disc(25), 25.0), (Back.rectangle(70, 150), 35.0), (L, 30 * (2 - sqrt(2)))],
)
def test_the_largest_body_has_its_closed_form(back, expected):
    assert expected <= largest_body(back) <= expected + 2e-4 * back.size


@settings(max_examples=10)
@given(st.integers(0, 2**31))
def test_the_largest_body_is_shapelys(random_region, seed):
    region = random_region(seed)
    found = largest_body(Back(region))
    assert (
        maximum_inscribed_circle(region, 1e-4).length - 1e-3 <= found <= maximum_inscribed_circle(region).length + 0.1
    )


def test_area_is_that_of_the_region_grown_by_half_the_gap():
    back = Back(MultiPolygon([box(0, 0, 10, 10), box(20, 0, 30, 10)])).keep_out("flash", disc((5.0, 5.0), 2.0))
    # Two squares far apart, one with a hole that shrinks; by how much the hole's corners overlap is not counted, pi 0.5^2 twice.
    grown = 2 * (100 + 40 * 0.5 + pi * 0.25) - pi * 1.5**2
    assert grown <= body_area(back, 1.0) <= grown + pi / 2 + 2e-4 * back.size**2


def test_the_box_is_grown_too():
    assert box_area(Back.disc(5), 2.0) == pytest.approx(144.0)


def test_a_locked_lens_reaches_no_farther_than_its_place():
    back = Back.rectangle(10, 10)
    locked = Reach.locked(back, (1.0, 1.0), np.array([0.5])).support
    free = Reach.free(back, np.array([1.0])).support
    assert most_apart(locked, free).item() == pytest.approx(hypot(8, 8), rel=TURN)
