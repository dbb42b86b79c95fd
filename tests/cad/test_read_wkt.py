import pytest

from multilens.back import Back
from multilens.cad.drawing import Wanted, back_of
from multilens.cad.read_wkt import read_wkt
from multilens.geometry.shape import polygon, rectangle

SQUARE = "POLYGON ((0 0, 40 0, 40 50, 0 50, 0 0))"


def read(text: str, units: str | None = "mm", **wanted: object) -> Back:
    return back_of(read_wkt(text, units), Wanted(**wanted)).back


def test_the_first_line_is_the_outline_and_y_turns_over():
    assert read(SQUARE) == Back(rectangle(40, 50, centre=(20, -25)))


def test_further_lines_are_keep_outs():
    back = read(
        f"{SQUARE}\n\nPOLYGON ((1 2, 3 2, 3 5, 1 2))\nPOLYGON ((5 2, 7 2, 7 5, 5 2))\n", units="cm", clearance=0.5
    )
    assert [keep_out.name for keep_out in back.keep_outs] == ["keep-out", "keep-out 2"]
    assert back.keep_outs[0].shape == polygon([(10, -20), (30, -20), (30, -50)])
    assert back.keep_outs[1].clearance == 0.5


def test_holes_and_parts_are_kept():
    shell, hole, other = "(0 0, 9 0, 9 9, 0 9, 0 0)", "(1 1, 1 2, 2 2, 2 1, 1 1)", "(20 0, 25 0, 25 5, 20 5, 20 0)"
    assert read(f"MULTIPOLYGON (({shell}, {hole}), ({other}))").outline.area == pytest.approx(81 - 1 + 25)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "layer outline of the outline must hold closed curves, got none there; the file has the layers none"),
        ("POLYGON ((0 0, 1", "line 1 must be well-known text"),
        (f"{SQUARE}\nCIRCLE (0 0 5)", "line 2 must be well-known text"),
        ("LINESTRING (0 0, 1 1)", "line 1 must be a Polygon or MultiPolygon, got a LineString"),
        ("POLYGON ((0 0, 9 0, 9 9))", "line 1 must be well-known text, .* not form a closed linestring"),
        ("POLYGON EMPTY", "line 1 must be a Polygon or MultiPolygon, got an empty one"),
        ("POLYGON ((0 0, nan 1, 5 5, 0 0))", "must be finite and within"),
        ("POLYGON ((0 0, 10 10, 10 0, 0 10, 0 0))", r"Self-intersection\[5 5\]"),
        (f"{SQUARE}\n" * 1001, "at most 1000 lines, got 1001"),
    ],
)
def test_what_is_no_polygon_is_refused(text: str, told: str):
    with pytest.raises(ValueError, match=told):
        read(text)


def test_units_are_always_told():
    with pytest.raises(ValueError, match=r"units must be known, got a file without them \(well-known text has none\)"):
        read(SQUARE, units=None)
