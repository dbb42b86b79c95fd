from math import pi

import numpy as np
import pytest
from shapely import LineString, Polygon

from multilens.back import Back
from multilens.cad.drawing import Wanted, back_of
from multilens.cad.read_svg import read_svg
from multilens.geometry.shape import disc, rectangle

PAGE = 'width="100mm" height="200mm" viewBox="0 0 100 200"'
SQUARE = '<rect id="outline" width="80" height="90"/>'


def svg(inside: str, page: str = PAGE) -> str:
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    return f"<svg {spaces} {page}>{inside}</svg>"


def read(inside: str, page: str = PAGE, units: str | None = None, **wanted: object) -> Back:
    return back_of(read_svg(svg(inside, page), units, 0.01), Wanted(**wanted)).back


def test_shapes_are_read_as_they_stand():
    back = read(
        '<g id="outline"><rect x="1" y="2" width="80" height="150" rx="9"/></g>'
        '<g inkscape:label="keep-outs"><circle id="flash" cx="20" cy="30" r="4"/>'
        '<polygon points="50,50 60,50 60,70" data-clearance="0.5"><title>a corner</title></polygon></g>'
    )
    assert back.outline == rectangle(80, 150, centre=(41, 77), corner=9)
    flash, corner = back.keep_outs
    assert (flash.name, flash.shape, flash.clearance) == ("flash", disc((20, 30), 4), 0.0)
    assert (corner.name, corner.clearance, corner.shape.area) == ("a corner", 0.5, 100.0)


@pytest.mark.parametrize(
    ("page", "scale"),
    [
        ('width="100mm" height="200mm" viewBox="0 0 100 200"', 1.0),
        ('width="10cm" height="20cm" viewBox="0 0 1000 2000"', 0.1),
        ('width="1in" height="2in" viewBox="0 0 96 192"', 25.4 / 96),
        ('width="72pt" height="144pt" viewBox="-5,-5,72,144"', 25.4 / 72),
        # Rounded by the program that wrote it: the smaller scale is the one that is drawn.
        ('width="100mm" height="200.01mm" viewBox="0 0 100 200"', 1.0),
    ],
)
def test_millimetres_come_from_width_height_and_viewbox(page: str, scale: float):
    left, top, right, bottom = read('<rect id="outline" x="3" y="4" width="80" height="90"/>', page).outline.bounds
    assert (left, top, right, bottom) == pytest.approx((3 * scale, 4 * scale, 83 * scale, 94 * scale))


@pytest.mark.parametrize(
    "page",
    [
        "",
        'viewBox="0 0 100 200"',
        'width="100" height="200" viewBox="0 0 100 200"',
        'width="100px" height="200px" viewBox="0 0 100 200"',
        'width="100%" height="100%" viewBox="0 0 100 200"',
        'width="100mm" height="200mm"',
    ],
)
def test_user_units_alone_are_no_units(page: str):
    with pytest.raises(ValueError, match=r"units must be known, got a file without them \(width, height and viewBox\)"):
        read(SQUARE, page)
    assert read(SQUARE, page, units="mm").outline == rectangle(80, 90)


def test_a_page_that_is_stretched_is_refused():
    with pytest.raises(ValueError, match="must have one scale, got 1 mm along x and 2 mm along y"):
        read(SQUARE, 'width="100mm" height="400mm" viewBox="0 0 100 200"')


def test_transforms_are_followed_from_the_inside_out():
    back = read(
        '<g transform="translate(50 60)"><g transform="scale(2)"><g transform="rotate(90)">'
        '<rect id="outline" width="10" height="20" rx="2"/></g></g></g>'
    )
    # Turned from x to y: (10, 20) comes to (-20, 10), doubled and moved.
    assert back.outline.bounds == pytest.approx((10, 60, 50, 80))
    assert back.outline.radius == pytest.approx(4)


@pytest.mark.parametrize(
    ("transform", "corner"),
    [
        ("", (1, 2)),
        ("none", (1, 2)),
        ("  translate( 5 )\n", (6, 2)),
        ("translate(5-6.5)", (6, -4.5)),
        ("translate(.5.25)", (1.5, 2.25)),
        ("translate(+5e0,6E-1),scale(2 1)", (7, 2.6)),
        ("matrix(1 0 0 1 5 6) skewX(0)", (6, 8)),
        ("rotate(0, 7, 8)", (1, 2)),
    ],
)
def test_a_transform_may_be_written_in_any_way_that_there_is(transform: str, corner: tuple[float, float]):
    outline = read(f'<g transform="{transform}"><rect id="outline" x="1" y="2" width="3" height="4"/></g>').outline
    assert outline.bounds[:2] == pytest.approx(corner)


@pytest.mark.parametrize(
    "transform",
    [
        "translate(5",
        "translate()",
        "translate(5 6 7)",
        "translate(5mm)",
        "translate(5) none",
        "scale(2),",
        "translate(5 x)",
        "Scale(2)",
        "turn(5)",
        "scale(2) 5",
        "matrix(1 0 0 1 5)",
        "rotate(5 6)",
        "scale(2);scale(3)",
    ],
)
def test_what_is_no_whole_transform_is_not_passed_over(transform: str):
    with pytest.raises(ValueError, match=r"transform must be one or more of matrix\(a b c d e f\), translate\(x y\)"):
        read(f'<g transform="{transform}">{SQUARE}</g>')


@pytest.mark.parametrize("rule", ["transform:translate(5px)", "fill:red; Rotate : 9deg", "transform-origin: 5px 5px"])
def test_a_transform_in_a_style_is_refused(rule: str):
    name = rule.rpartition(";")[2].partition(":")[0].strip().lower()
    for shapes in (f'<g style="{rule}">{SQUARE}</g>', SQUARE.replace("/>", f' style="{rule}"/>')):
        with pytest.raises(ValueError, match=f"must be moved by an attribute transform alone, got {name}"):
            read(shapes)
    with pytest.raises(ValueError, match=f"alone, got {name}"):
        read(SQUARE, f'{PAGE} style="{rule}"')


def test_an_origin_of_a_transform_is_refused():
    with pytest.raises(ValueError, match="by an attribute transform alone, got transform-origin"):
        read(f'<g transform="rotate(9)" transform-origin="5 5">{SQUARE}</g>')


def test_a_mirrored_circle_is_a_circle_and_a_stretched_one_is_cut():
    mirrored = read('<g transform="scale(1,-1)"><circle id="outline" cx="5" cy="-9" r="4"/></g>')
    assert mirrored.outline == disc((5, 9), 4)
    stretched = read('<circle id="outline" r="4" transform="scale(2 1)"/>').outline
    assert stretched.radius == 0
    assert pi * 4 * 8 * 0.995 < stretched.area < pi * 4 * 8


@pytest.mark.parametrize(
    ("sweep", "large", "middle"),
    [(1, 0, (5, -5)), (0, 0, (5, 5))],
)
def test_arcs_turn_the_way_that_the_flag_says(sweep: int, large: int, middle: tuple[float, float]):
    outline = read(f'<path id="outline" d="M 0 0 A 5 5 0 {large} {sweep} 10 0 Z"/>').outline
    assert outline.core.distance(LineString([middle, middle])) < 0.02
    assert outline.area == pytest.approx(12.5 * pi, rel=1e-2)


@pytest.mark.parametrize(
    ("path", "bezier"),
    [
        ("M 0 0 C 0 40 60 40 60 0 Z", [(0, 0), (0, 40), (60, 40), (60, 0)]),
        ("M 0 0 Q 30 60 60 0 Z", [(0, 0), (20, 40), (40, 40), (60, 0)]),
    ],
)
def test_bezier_curves_are_cut_on_the_safe_side(path: str, bezier: list[tuple[float, float]]):
    t = np.linspace(0, 1, 20_001)[:, None]
    a, b, c, d = np.array(bezier, dtype=float)
    true = Polygon((1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d)
    back = read(f'{SQUARE}<path id="keep-outs" d="{path}"/>')
    outline = read(f'<path id="outline" d="{path}"/>').outline.core
    assert true.contains(outline)
    assert back.keep_outs[0].shape.core.contains(true)
    assert outline.hausdorff_distance(true) < 0.012
    assert back.keep_outs[0].shape.core.hausdorff_distance(true) < 0.012


def test_two_rings_of_one_path_make_a_hole():
    back = read(f'{SQUARE}<path id="keep-outs" d="M 0 0 h 10 v 10 h -10 z M 2 2 v 6 h 6 v -6 z"/>')
    assert back.keep_outs[0].shape.area == pytest.approx(64)


def test_what_is_not_drawn_is_not_read():
    in_defs = '<defs><rect id="keep-outs" width="1" height="1"/></defs>'
    hidden = '<g display="none"><rect id="keep-outs" width="9" height="9"/></g>'
    styled = '<rect id="keep-outs" style="fill:red; display: none" width="9" height="9"/>'
    assert read(SQUARE + in_defs + hidden + styled).keep_outs == ()


BOMB = '<!DOCTYPE svg [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>'
DEEP = "<g>" * 100 + "</g>" * 100


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (BOMB + svg("<title>&b;</title>" + SQUARE), "SVG must not declare entities, got 'a'"),
        (
            '<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]>' + svg("<title>&x;</title>"),
            "must not declare entities",
        ),
        (svg(DEEP), "at most 64 deep"),
        (svg("<g/>" * 30_000), "hold 20000 elements"),
        (svg("<g>"), "SVG must be whole XML"),
        ("", "SVG must be whole XML"),
        ("<html/>", "must begin with an element svg, got 'html'"),
        (svg('<use id="outline" href="#a"/>'), "an element use cannot be read: make it a path of its own"),
        (svg('<line id="outline" x2="9"/>'), "an element line cannot be read"),
        (
            svg('<path id="outline" d="M 0 0 L 50 0 L 50 50"/>'),
            r"curve must be closed, got ends 70.7107 mm apart, at \(0, 0\) mm",
        ),
        (svg('<path id="outline" d="M 0 0 L nan 0 L 50 50 Z"/>'), "a path must be well formed"),
        (svg('<path id="outline" d="M 0 0 L 1e999 0 L 50 50 Z"/>'), "must be finite and within"),
        (svg('<path id="outline" d="M 0 0 L 9 9 L 9 0 L 0 9 Z"/>'), r"Self-intersection\[4.5 4.5\]"),
        (svg('<path id="outline" d="nothing"/>'), "a shape must bound something, got nothing"),
        (svg('<circle id="outline" r="3mm"/>'), "r must be a plain finite number, >= 0, got '3mm'"),
        (svg('<circle id="outline" r="0"/>'), "a shape must bound something, got nothing"),
        (svg('<rect id="outline" width="-4" height="5"/>'), "width must be a plain finite number, >= 0, got '-4'"),
        (svg('<rect width="4" height="5"/>'), "got none there; the file has the layers none"),
        (
            svg('<g transform="rotate(x)"><rect id="outline" width="4" height="5"/></g>'),
            "transform must be one or more of matrix",
        ),
        (
            svg(f'<g transform="{"translate(" * 20_000}">{SQUARE}</g>'),
            "transform must be at most 1000 characters, got 200000",
        ),
        (
            svg(f'<polygon id="outline" points="0,0 1,1 {"9" * 10_000}"/>'),
            "points must be a plain finite number, got '999",
        ),
        (svg('<polygon id="outline" points="0,0 1,1 2"/>'), "points must be pairs of numbers, got 5 numbers"),
        (svg('<path id="outline" d="M 0 0 A 5 5e7 0 0 1 10 5 Z"/>'), "curve must be at most 10000 edges"),
        (svg('<path id="outline" d="M 0 0 L 5 5 Z"/>'), "curve must have at least 3 corners, got 2"),
        (svg(SQUARE, 'width="100mm" height="200mm" viewBox="0 0 0 200"'), "viewBox must be a plain finite number"),
    ],
)
def test_what_cannot_be_trusted_or_bounds_nothing_is_refused(text: str, told: str):
    with pytest.raises(ValueError, match=told):
        back_of(read_svg(text, None, 0.01), Wanted())


def test_a_document_type_without_entities_is_welcome():
    head = '<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    assert back_of(read_svg(head + svg(SQUARE), None, 0.01), Wanted()).back.outline == rectangle(80, 90)
