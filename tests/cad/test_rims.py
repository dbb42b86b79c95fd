import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiPoint, Point, Polygon
from shapely.geometry import box

from multilens.cad.rims import OUTWARD, rims
from multilens.cad.shapes import grown_core
from multilens.geometry.shape import Shape, disc, rectangle


def test_a_disc_is_a_circle():
    (curve,) = rims(disc((3, 4), 2))
    assert curve.centres.tolist() == [[3, 4], [3, 4]]
    assert curve.radii.tolist() == [2, 2]


def test_a_rounded_rectangle_has_four_quarter_circles_and_four_lines():
    (curve,) = rims(rectangle(20, 30, corner=5))
    assert sorted(np.round(curve.bulges, 12)) == [0] * 4 + [round(2**0.5 - 1, 12)] * 4
    assert Polygon(curve.cut(1e-4)).area == pytest.approx(rectangle(20, 30, corner=5).area, rel=1e-4)


def test_holes_and_parts_are_curves_of_their_own(random_region):
    for seed in range(5):
        region = random_region(seed)
        lengths = sum(Polygon(curve.points).exterior.length for curve in rims(Shape(region)))
        assert lengths == pytest.approx(region.length)


@given(st.lists(st.tuples(st.integers(-99, 99), st.integers(-99, 99)), min_size=1, max_size=9), st.floats(0.01, 50))
def test_a_convex_core_comes_back_from_its_rim(points: list[tuple[int, int]], radius: float):
    core = MultiPoint([(x / 3, y / 7) for x, y in points]).convex_hull
    shape = Shape(core, round(radius, 6))
    back = grown_core(rims(shape)[0])
    assert back is not None
    assert back.core.hausdorff_distance(shape.core) < 1e-6
    assert back.radius == pytest.approx(shape.radius, abs=1e-6)


def test_a_core_with_a_notch_is_drawn_outside_of_what_it_is_by_little():
    core = box(0, 0, 20, 20).difference(box(10, 10, 30, 30))
    shape = Shape(core, 2.5)
    drawn = Polygon(rims(shape)[0].points)
    fine = core.buffer(2.5, quad_segs=2000)
    assert drawn.contains(fine)
    assert drawn.hausdorff_distance(fine) < 2 * OUTWARD


def test_a_bent_line_is_drawn_outside_too():
    shape = Shape(LineString([(0, 0), (10, 0), (10, 10)]), 1.0)
    assert Polygon(rims(shape)[0].points).contains(shape.core.buffer(1.0, quad_segs=500))


def test_a_point_of_no_radius_is_no_shape():
    with pytest.raises(ValueError, match="area"):
        Shape(Point(0, 0), 0.0)
