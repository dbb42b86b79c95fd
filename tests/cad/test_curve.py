from math import pi, sqrt

import numpy as np
import pytest
from shapely import Point, Polygon

from multilens.cad.curve import Curve, circle, tidy

QUARTER = sqrt(2) - 1
"""Bulge of a quarter of a circle, tan 22.5 degrees."""


def test_a_positive_bulge_turns_from_x_to_y():
    # From (1, 0) to (0, 1) around the origin, and straight back.
    curve = Curve(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([QUARTER, 0.0]))
    assert curve.centres == pytest.approx(np.zeros((1, 2)), abs=1e-15)
    assert curve.radii == pytest.approx([1.0])
    assert curve.middles[0] == pytest.approx([sqrt(0.5), sqrt(0.5)])


def test_a_negative_bulge_turns_from_y_to_x():
    curve = Curve(np.array([[0.0, 1.0], [1.0, 0.0]]), np.array([-QUARTER, 0.0]))
    assert curve.centres == pytest.approx(np.zeros((1, 2)), abs=1e-15)
    assert curve.middles[0] == pytest.approx([sqrt(0.5), sqrt(0.5)])


@pytest.mark.parametrize("sagitta", [1.0, 0.1, 1e-3])
def test_arcs_are_cut_with_their_ends_on_them_and_within_the_sagitta(sagitta: float):
    corners = circle((3.0, -4.0), 13.0).cut(sagitta)
    assert np.hypot(*(corners - [3, -4]).T) == pytest.approx(13.0)
    assert Polygon(corners).exterior.distance(Point(3, -4)) >= 13 - sagitta * (1 + 1e-9)


def test_a_small_circle_is_not_cut_to_nothing():
    assert Polygon(circle((0.0, 0.0), 0.1).cut(5.0)).area > 0.85 * pi * 0.01


def test_pieces_of_no_length_are_left_out():
    curve = tidy(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]), np.arange(5.0))
    assert curve.points.tolist() == [[1, 0], [0, 1], [0, 0]] or len(curve.points) == 3
    assert len(curve.bulges) == 3


def test_a_curve_that_is_a_point_is_refused():
    with pytest.raises(ValueError, match="at least 2 points apart, got 0"):
        tidy(np.zeros((3, 2)), np.zeros(3))


@pytest.mark.parametrize("wild", [float("nan"), float("inf"), 1e7])
def test_what_is_not_finite_or_too_far_is_refused(wild: float):
    with pytest.raises(ValueError, match="must be finite and within 1e"):
        Curve(np.array([[0.0, 0.0], [wild, 10.0], [10.0, 0.0]]), np.zeros(3))


@pytest.mark.parametrize("wild", [float("nan"), float("inf"), 1e300])
def test_a_bulge_without_measure_is_refused(wild: float):
    with pytest.raises(ValueError, match="bulge must be finite"):
        Curve(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([wild, 0.0]))


def test_an_arc_that_reaches_too_far_is_refused():
    with pytest.raises(ValueError, match="must be finite and within 1e"):
        Curve(np.array([[0.0, 0.0], [1000.0, 0.0]]), np.array([1e5, 0.0]))
