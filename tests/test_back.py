"""Backs: outlines, keep-outs and the region that is left."""

from math import inf, nan, pi

import pytest
import shapely
from shapely import LineString, MultiPolygon, Polygon, box

from multilens import Back, disc, rectangle
from multilens.geometry.shape import Shape

SQUARE = box(0, 0, 100, 100)


def test_region_is_the_outline_less_its_keep_outs_grown_by_their_clearance():
    back = Back(SQUARE).keep_out("logo", box(40, 40, 60, 60), clearance=5.0)
    grown = 20 * 20 + 4 * 20 * 5 + pi * 5**2
    # The round corners are cut into 64 edges each, which loses (2 pi / 256)^2 / 6 of their area.
    assert back.region().area == pytest.approx(100 * 100 - grown, abs=0.01)


def test_region_of_several_parts_keeps_them():
    assert len(shapely.get_parts(Back(MultiPolygon([box(0, 0, 1, 1), box(2, 0, 3, 1)])).region())) == 2


def test_a_keep_out_may_cut_a_back_in_two():
    assert len(shapely.get_parts(Back(SQUARE).keep_out("band", box(-1, 40, 101, 60)).region())) == 2


def test_rectangle_starts_at_the_origin():
    assert Back.rectangle(30, 20).outline.bounds == (0, 0, 30, 20)


def test_rounded_rectangle_starts_at_the_origin():
    assert Back.rounded_rectangle(71.5, 147.5, corner=10).outline.bounds == (0, 0, 71.5, 147.5)


def test_disc_is_centred_on_the_origin():
    assert Back.disc(20).outline.bounds == (-20, -20, 20, 20)


def test_size_is_the_diagonal():
    assert Back.rectangle(30, 40).size == 50


def test_keep_out_leaves_the_back_it_is_called_on_alone():
    back = Back.rectangle(30, 20)
    back.keep_out("flash", disc((5.0, 5.0), 1.0))
    assert back.keep_outs == ()


def test_keep_outs_need_names_of_their_own():
    back = Back.rectangle(30, 20).keep_out("flash", disc((5.0, 5.0), 1.0))
    with pytest.raises(ValueError, match="names of their own, got flash twice"):
        back.keep_out("flash", disc((15.0, 5.0), 1.0))


@pytest.mark.parametrize("clearance", [-1.0, nan, inf, 1e300])
def test_a_clearance_out_of_range_is_refused_by_the_name_of_the_keep_out(clearance):
    with pytest.raises(ValueError, match="clearance of keep-out flash must be from 0"):
        Back.rectangle(30, 20).keep_out("flash", disc((5.0, 5.0), 1.0), clearance)


def test_a_keep_out_that_is_no_shape_is_named():
    with pytest.raises(ValueError, match=r"keep-out flash: .*\[5 5\]"):
        Back.rectangle(30, 20).keep_out("flash", Polygon([(0, 0), (10, 10), (10, 0), (0, 10)]))


def test_an_outline_that_is_no_shape_is_named():
    with pytest.raises(ValueError, match=r"outline: .*\[5 5\]"):
        Back(Polygon([(0, 0), (10, 10), (10, 0), (0, 10)]))


def test_a_line_is_no_outline():
    with pytest.raises(ValueError, match="outline: shape must have an area, got a LineString"):
        Back(LineString([(0, 0), (10, 0)]))


@pytest.mark.parametrize(
    "core",
    [
        Polygon([(0, 0), (10, 0), (10, 10), (5, 5), (0, 10)]),
        SQUARE.difference(box(40, 40, 60, 60)),
        MultiPolygon([box(0, 0, 1, 1), box(2, 0, 3, 1)]),
        LineString([(0, 0), (10, 0), (10, 10)]),
    ],
    ids=["notch", "hole", "parts", "bent line"],
)
def test_round_outlines_need_a_convex_core(core):
    # Inside a grown core that is not convex the distance to the rim is not that to the core plus the radius.
    with pytest.raises(ValueError, match="must have a convex core"):
        Back(Shape(core, 2.0))


@pytest.mark.parametrize("shape", [rectangle(10, 20, corner=3), rectangle(10, 20, corner=5), disc((0.0, 0.0), 4.0)])
def test_round_outlines_of_a_convex_core_are_accepted(shape):
    assert Back(shape).outline == shape


def test_a_scaled_back_keeps_its_middle_and_its_proportions():
    outline = Back(rectangle(10, 20, centre=(50, 70), corner=2)).scaled(1.5).outline
    assert outline == rectangle(15, 30, centre=(50, 70), corner=3)


def test_what_stands_on_a_scaled_back_stays():
    back = Back(SQUARE).keep_out("logo", disc((60, 60), 4), clearance=1)
    assert back.scaled(0.5).keep_outs == back.keep_outs


@pytest.mark.parametrize("factor", [0.0, -1.0, nan, inf])
def test_a_back_is_scaled_by_positive_numbers(factor: float):
    with pytest.raises(ValueError, match="factor must be > 0 and finite"):
        Back(SQUARE).scaled(factor)


def test_a_bodys_centre_reaches_as_far_as_its_radius_leaves():
    corners = Back(SQUARE).corners_for(10)
    assert {tuple(corner) for corner in corners.tolist()} == {(10, 10), (10, 90), (90, 10), (90, 90)}


def test_a_body_that_does_not_fit_has_no_corners():
    assert len(Back(SQUARE).corners_for(51)) == 0
