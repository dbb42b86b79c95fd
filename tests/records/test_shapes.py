"""Shapes and backs to a file and back."""

import json
from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiPolygon, Polygon

from multilens.back import Back
from multilens.geometry.shape import Shape, disc, polygon
from multilens.records import back_record, read_back, read_shape, shape_record


def through_json(value):
    """What a file gives back."""
    return json.loads(json.dumps(value, allow_nan=False))


@st.composite
def stars(draw, middle=(0.0, 0.0)):
    """A polygon seen whole from its middle: never crosses itself, of any outline."""
    radii = draw(st.lists(st.floats(5.0, 10.0), min_size=3, max_size=12))
    x, y = middle
    return [
        (x + radius * cos(2 * pi * k / len(radii)), y + radius * sin(2 * pi * k / len(radii)))
        for k, radius in enumerate(radii)
    ]


@given(stars(), st.booleans())
def test_a_polygon_comes_back_to_the_bit(points, with_hole):
    hole = [[(1.0, 1.0), (1.0, 0.1), (0.3, 1.0)]] if with_hole else []
    shape = Shape(Polygon(points, hole))
    back = read_shape(through_json(shape_record(shape)), "outline")
    assert back.core.equals_exact(shape.core)
    assert back.segments.tobytes() == shape.segments.tobytes()


@pytest.mark.parametrize(
    "shape",
    [
        disc((0.1, -0.2), 0.3),
        Shape(LineString([(0.1, 0.2), (0.7, 0.2), (0.7, 0.9)]), 0.1),
        Shape(MultiPolygon([Polygon([(0, 0), (0, 1), (1, 0)]), Polygon([(5, 5), (5, 6.1), (6, 5)])])),
        Shape(Polygon([(0, 0), (0, 1), (1, 1), (1, 0)]), 0.25),
    ],
    ids=["point", "line", "parts", "rounded"],
)
def test_every_kind_of_core_comes_back(shape):
    back = read_shape(through_json(shape_record(shape)), "outline")
    assert back.radius == shape.radius
    assert back.core.geom_type == shape.core.geom_type
    assert back.segments.tobytes() == shape.segments.tobytes()


def test_keep_outs_come_back_with_their_names_and_clearances():
    back = Back.rounded_rectangle(70, 150, 13).keep_out("micrófono", disc((30, 10), 3), 0.5)
    back = back.keep_out("logo", polygon([(20, 70), (30, 70), (25, 80)]))
    again = read_back(through_json(back_record(back)), "back")
    assert [(k.name, k.clearance) for k in again.keep_outs] == [("micrófono", 0.5), ("logo", 0.0)]
    assert back_record(again) == back_record(back)
