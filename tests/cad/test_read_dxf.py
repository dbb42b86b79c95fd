"""Drawings as other programs make them, drawn here with ezdxf."""

from collections.abc import Callable
from io import StringIO
from math import cos, radians, sin

import ezdxf
import numpy as np
import pytest
from ezdxf.layouts import Modelspace
from shapely import Polygon

from multilens.back import Back
from multilens.cad.drawing import Wanted, back_of
from multilens.cad.read_dxf import read_dxf
from multilens.geometry.shape import disc, rectangle

MM, INCH = 4, 1


def drawing(draw: Callable[[Modelspace], object], units: int = MM) -> str:
    document = ezdxf.new("R2010", units=units)
    draw(document.modelspace())
    text = StringIO()
    document.write(text)
    return text.getvalue()


def read(draw: Callable[[Modelspace], object], units: int = MM, told: str | None = None, **wanted: object) -> Back:
    text = drawing(draw, units)
    return back_of(read_dxf(text, told, 0.01), Wanted(**{"outline": "HOUSING", **wanted})).back


def lines_and_arcs(space: Modelspace, factor: float = 1.0) -> None:
    """A rectangle of 60 x 100 with corners of 8, its lower left at the origin, as loose lines and arcs in no order."""
    at = {"layer": "HOUSING"}
    for x, y, start in ((52, 92, 0), (8, 8, 180), (8, 92, 90), (52, 8, 270)):
        space.add_arc((x * factor, y * factor), 8 * factor, start, start + 90, dxfattribs=at)
    for a, b in (((60, 8), (60, 92)), ((8, 0), (52, 0)), ((0, 92), (0, 8)), ((52, 100), (8, 100))):
        space.add_line((a[0] * factor, a[1] * factor), (b[0] * factor, b[1] * factor), dxfattribs=at)


def test_loose_lines_and_arcs_become_a_rounded_rectangle_and_y_turns_over():
    back = read(lines_and_arcs)
    assert back.outline == rectangle(60, 100, centre=(30, -50), corner=8)


def test_inches_are_read_and_become_millimetres():
    back = read(lambda space: lines_and_arcs(space, 1 / 25.4), units=INCH)
    assert back.outline == rectangle(60, 100, centre=(30, -50), corner=8)


def test_a_file_without_units_is_refused_unless_the_user_says_which():
    with pytest.raises(ValueError, match=r"units must be known.*INSUNITS=0.*units=mm"):
        read(lines_and_arcs, units=0)
    assert read(lines_and_arcs, units=0, told="cm").outline == rectangle(600, 1000, centre=(300, -500), corner=80)


def test_units_that_contradict_the_file_are_refused():
    with pytest.raises(ValueError, match=r"in which 1 is 25.4 mm \(\$INSUNITS=1\), or not be given, got mm"):
        read(lines_and_arcs, units=INCH, told="mm")


def test_curves_drawn_from_below_are_where_they_seem():
    # AutoCAD writes what was mirrored so: on an axis that points down, with x reversed.
    def draw(space: Modelspace) -> None:
        space.add_lwpolyline([(0, 0), (40, 0), (40, 50), (0, 50)], close=True, dxfattribs={"layer": "HOUSING"})
        space.add_circle((-30, 10), 2, dxfattribs={"layer": "FLASH", "extrusion": (0, 0, -1)})

    assert read(draw, keep_outs=("FLASH",)).keep_outs[0].shape == disc((30, -10), 2)


def test_a_keep_out_is_called_as_its_layer_and_clears_as_told():
    def draw(space: Modelspace) -> None:
        lines_and_arcs(space)
        for x in (10, 20):
            space.add_circle((x, 50), 2, dxfattribs={"layer": "Screw"})
        space.add_lwpolyline([(30, 30, 0, 0, 1), (34, 30, 0, 0, 1)], close=True, dxfattribs={"layer": "LED"})

    back = read(draw, keep_outs=("LED", "SCREW"), clearance=0.3)
    assert [(keep_out.name, keep_out.clearance) for keep_out in back.keep_outs] == [
        ("LED", 0.3),
        ("SCREW", 0.3),
        ("SCREW 2", 0.3),
    ]
    assert back.keep_outs[0].shape == disc((32, -30), 2)


def test_a_keep_out_within_another_makes_no_hole():
    def draw(space: Modelspace) -> None:
        lines_and_arcs(space)
        for radius in (5, 2):
            space.add_circle((30, 50), radius, dxfattribs={"layer": "LED"})

    back = read(draw, keep_outs=("LED",))
    assert [keep_out.shape for keep_out in back.keep_outs] == [disc((30, -50), 5), disc((30, -50), 2)]


def test_curves_on_the_outline_make_parts_and_holes():
    def draw(space: Modelspace) -> None:
        for x, y, side in ((0, 0, 40), (10, 10, 5), (60, 0, 20)):
            ring = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
            space.add_lwpolyline(ring, close=True, dxfattribs={"layer": "HOUSING"})

    assert read(draw).outline.area == pytest.approx(1600 - 25 + 400)


@pytest.mark.parametrize("kind", ["ellipse", "spline"])
def test_other_curves_are_cut_on_the_safe_side(kind: str):
    def draw(space: Modelspace) -> None:
        if kind == "ellipse":
            for layer, size in (("HOUSING", 50), ("LED", 5)):
                space.add_ellipse((0, 0), (size, 0), ratio=0.6, dxfattribs={"layer": layer})
        else:
            for layer, size in (("HOUSING", 50), ("LED", 5)):
                points = [(size * cos(radians(a)), 0.6 * size * sin(radians(a))) for a in range(0, 360, 5)]
                space.add_spline([*points, points[0]], dxfattribs={"layer": layer})

    back = read(draw, keep_outs=("LED",))
    x, y = np.cos(np.linspace(0, 2 * np.pi, 5000)), 0.6 * np.sin(np.linspace(0, 2 * np.pi, 5000))
    # A spline through points of an ellipse is not the ellipse, by a little.
    slack = 1 + (1e-9 if kind == "ellipse" else 2e-4)
    assert Polygon(np.stack([50 * x, 50 * y], axis=-1) * slack).contains(back.outline.core)
    assert back.outline.area == pytest.approx(np.pi * 50 * 30, rel=1e-3)
    assert (
        back.keep_outs[0]
        .shape.core.buffer(5 * (slack - 1))
        .contains(Polygon(np.stack([5 * x, 5 * y], axis=-1) / slack))
    )


def test_texts_and_dimensions_on_a_layer_are_passed_over():
    def draw(space: Modelspace) -> None:
        lines_and_arcs(space)
        space.add_text("HOUSING, 60 x 100", dxfattribs={"layer": "HOUSING"})
        space.add_linear_dim((0, -10), (0, 0), (60, 0), dxfattribs={"layer": "HOUSING"})

    assert read(draw).outline == rectangle(60, 100, centre=(30, -50), corner=8)


def open_polyline(space: Modelspace) -> None:
    space.add_lwpolyline([(0, 0), (40, 0), (40, 50)], dxfattribs={"layer": "HOUSING"})


def gap(space: Modelspace) -> None:
    lines_and_arcs(space)
    space.delete_entity(next(iter(space.query("LINE"))))


def hatch(space: Modelspace) -> None:
    lines_and_arcs(space)
    space.add_hatch(dxfattribs={"layer": "HOUSING"})


def block(space: Modelspace) -> None:
    space.doc.blocks.new("PHONE").add_circle((0, 0), 50)  # pyright: ignore[reportOptionalMemberAccess] it has a document
    space.add_blockref("PHONE", (0, 0), dxfattribs={"layer": "HOUSING"})


def tilted(space: Modelspace) -> None:
    space.add_circle((0, 0), 50, dxfattribs={"layer": "HOUSING", "extrusion": (0, 1, 1)})


def bowtie(space: Modelspace) -> None:
    space.add_lwpolyline([(0, 0), (10, 10), (10, 0), (0, 10)], close=True, dxfattribs={"layer": "HOUSING"})


def not_a_number(space: Modelspace) -> None:
    space.add_lwpolyline([(0, 0), (10, float("nan")), (10, 0)], close=True, dxfattribs={"layer": "HOUSING"})


@pytest.mark.parametrize(
    ("draw", "told"),
    [
        (open_polyline, r"curve must be closed, got ends 64.0312 mm apart, from \(0, 0\) to \(40, 50\) mm"),
        (gap, r"curve must be closed, got ends 84 mm apart"),
        (hatch, r"a HATCH cannot be read: explode it into curves, or put it on another layer"),
        (block, r"an? INSERT cannot be read"),
        (tilted, r"a CIRCLE must lie in the plane of x and y"),
        (bowtie, r"outline: shape must not cross itself .* Self-intersection\[5 5\]"),
        (not_a_number, r"must be finite and within"),
        (
            lambda space: space.add_circle((0, 0), 5, dxfattribs={"layer": "0"}),
            r"layer HOUSING of the outline.* layers 0$",
        ),
        (
            lambda space: space.add_circle((0, 0), 0, dxfattribs={"layer": "HOUSING"}),
            r"outline: shape must have an area, got a Point",
        ),
    ],
)
def test_what_bounds_nothing_is_refused_with_the_layer(draw: Callable[[Modelspace], object], told: str):
    with pytest.raises(ValueError, match=told):
        read(draw)


def test_what_is_on_other_layers_may_be_anything():
    def draw(space: Modelspace) -> None:
        lines_and_arcs(space)
        space.add_line((0, 0), (5, 5), dxfattribs={"layer": "AXES"})
        space.add_circle((0, 0), 1e9, dxfattribs={"layer": "FAR"})
        space.add_mesh(dxfattribs={"layer": "SOLID"})

    assert read(draw).outline == rectangle(60, 100, centre=(30, -50), corner=8)


@pytest.mark.parametrize("text", ["", "no drawing", "0\nSECTION\n2\nENTITIES\n0\n", "AutoCAD Binary DXF\r\n\x1a\x00"])
def test_what_is_no_dxf_is_refused(text: str):
    with pytest.raises(ValueError, match=r"DXF must be|units must be known"):
        read_dxf(text, None, 0.01)


def test_a_drawing_that_is_cut_off_is_refused_wherever_it_is():
    whole = drawing(lines_and_arcs)
    for end in range(0, len(whole), len(whole) // 40):
        try:
            back_of(read_dxf(whole[:end], "mm", 0.01), Wanted(outline="HOUSING"))
        except ValueError:
            continue
        pytest.fail(f"{end} of {len(whole)} characters were taken for a drawing")
