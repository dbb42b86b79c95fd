"""SVG: shapes by group or id, transformed and scaled to millimetres; their geometry by svgelements."""

# What svgelements has parsed has numbers and points where its types allow None.
# pyright: reportOptionalOperand=false, reportOperatorIssue=false

import re
from collections.abc import Iterator
from math import ceil, isclose, isfinite, sqrt, tan
from typing import Any
from xml.etree.ElementTree import Element, fromstring
from xml.parsers.expat import ExpatError, ParserCreate

import numpy as np
import svgelements
from svgelements import Arc, Close, CubicBezier, Line, Matrix, Move, Path, QuadraticBezier

from multilens.cad.curve import Curve, refuse_too_many, tidy
from multilens.cad.drawing import Drawing, Part
from multilens.cad.units import scale_of

NAMESPACES = ("{http://www.w3.org/2000/svg}", "")
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
CLEARANCE = "data-clearance"

NUMBERS = ("x", "y", "width", "height", "rx", "ry", "cx", "cy", "r")
SIZES = ("width", "height", "rx", "ry", "r")
ROUND = {"circle": svgelements.Circle, "ellipse": svgelements.Ellipse, "rect": svgelements.Rect}
POINTED = {"polygon": svgelements.Polygon, "polyline": svgelements.Polyline}
GROUPS = ("g", "a")
ELSEWHERE = ("use", "svg", "switch", "line")
"""Elements that draw others again or somewhere else, or a line: they bound nothing that is read, and must not be passed over."""

PHYSICAL = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "Q": 0.25}
"""mm; px is no length: programs differ in how large it is."""

ALIKE = 1e-3
"""Part of a scale by which those along x and y may differ: width and height are often rounded."""

CIRCULAR = 1e-9
"""Part of a radius by which both of an arc may differ."""

MOST_ELEMENTS, DEEPEST, LONGEST_TRANSFORM = 20_000, 64, 1000

NUMBER = r"(?>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
APART = r"(?>\s*,?\s*)"
ARGUMENTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}
"""How many numbers each transform takes."""

ONE = "|".join(
    rf"{name}\s*\(\s*{NUMBER}(?:{APART}{NUMBER}){{{count - 1}}}\s*\)"
    for name, counts in ARGUMENTS.items()
    for count in counts
)
TRANSFORM = re.compile(rf"\s*+(?:none|(?:{ONE})(?:{APART}(?:{ONE}))*+)?\s*", re.ASCII)
"""No step of it is undone where the next does not match, so that no text takes long."""

KNOWN = "matrix(a b c d e f), translate(x y), scale(x y), rotate(degrees x y), skewX(degrees) and skewY(degrees)"

FROM_STYLE = ("transform", "transform-origin", "transform-box", "translate", "rotate", "scale")
"""Words of a style that move shapes, too."""


# What is not finite numpy warns of; a curve refuses it.
@np.errstate(all="ignore")
def read_svg(text: str, units: str | None, tolerance: float) -> Drawing:
    """Read the shapes of an SVG that are drawn, y downwards.

    A shape can be asked for by the id or Inkscape's label of itself or of any group that it is in.

    Args:
        text: of the file.
        units: that one user unit is, told by the user; None for files whose width and height are lengths.
        tolerance: within which curves that are no arcs are cut into edges, mm.

    Raises:
        ValueError: it is no SVG, declares entities, is too deep, or the units are unknown.
    """
    root = _root(text)
    factor = scale_of(units, _millimetres(root), "width, height and viewBox", "units=mm")
    parts = _parts(root, _matrix(root), (), factor, tolerance)
    return Drawing(tuple(parts), y_up=False)


def _root(text: str) -> Element:
    """Parse a text that declares nothing: a few entities can stand for gigabytes."""

    def refuse(*declared: Any) -> None:
        raise ValueError(f"SVG must not declare entities, got {declared[0]!r:.40}: save it as plain SVG")

    depth = count = 0

    def go_down(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST or count > MOST_ELEMENTS:
            raise ValueError(f"SVG must be at most {DEEPEST} deep and hold {MOST_ELEMENTS} elements, got more")

    def go_up(name: str) -> None:
        nonlocal depth
        depth -= 1

    parser = ParserCreate()
    parser.EntityDeclHandler, parser.StartElementHandler, parser.EndElementHandler = refuse, go_down, go_up
    try:
        parser.Parse(text, True)
    except ExpatError as error:
        raise ValueError(f"SVG must be whole XML, got {error}") from None
    root = fromstring(text)
    if _kind(root) != "svg":
        raise ValueError(f"SVG must begin with an element svg, got {root.tag!r:.40}")
    return root


def _kind(element: Element) -> str:
    """Give the name of an element of SVG, and nothing for those of others."""
    tag = str(element.tag)
    return next(
        (tag.removeprefix(space) for space in NAMESPACES if tag.startswith(space) and "}" not in tag[len(space) :]), ""
    )


def _millimetres(root: Element) -> float | None:
    """Give the millimetres of a user unit; None where width and height are no lengths or nothing says how many units they are."""
    lengths = [_length(root.get(name, "")) for name in ("width", "height")]
    box = root.get("viewBox", "").replace(",", " ").split()
    if len(box) != 4 or None in lengths:
        return None
    scales = [
        length / _number("viewBox", size) for length, size in zip(lengths, box[2:], strict=True) if length is not None
    ]
    if not isclose(*scales, rel_tol=ALIKE):
        raise ValueError(f"SVG must have one scale, got {scales[0]:g} mm along x and {scales[1]:g} mm along y per unit")
    return min(scales)


def _length(text: str) -> float | None:
    unit = next((unit for unit in PHYSICAL if text.strip().endswith(unit)), None)
    return None if unit is None else PHYSICAL[unit] * _number("width and height", text.strip().removesuffix(unit))


def _number(name: str, text: str) -> float:
    try:
        number = float(text.strip().removesuffix("px"))
    except ValueError:
        number = float("nan")
    if not isfinite(number) or (name == "viewBox" and number <= 0) or (name in SIZES and number < 0):
        raise ValueError(f"{name} must be a plain finite number{', >= 0' if name in SIZES else ''}, got {text!r:.40}")
    return number


def _parts(element: Element, above: Matrix, layers: tuple[str, ...], factor: float, tolerance: float) -> Iterator[Part]:
    for child in element:
        kind = _kind(child)
        names = [name for name in (child.get(LABEL), child.get("id")) if name]
        if "none" in (child.get("display"), _style(child).get("display")):
            continue
        inside = (*layers, *dict.fromkeys(names))
        if kind in GROUPS:
            yield from _parts(child, _matrix(child) * above, inside, factor, tolerance)
        elif kind in ELSEWHERE:
            yield Part(
                inside, fault=f"an element {kind} cannot be read: make it a path of its own, or put it in another group"
            )
        elif kind == "path" or kind in ROUND or kind in POINTED:
            title = next((part.text for part in child if _kind(part) == "title" and part.text), "")
            clearance = child.get(CLEARANCE)
            said = None if clearance is None else factor * _number(CLEARANCE, clearance)
            matrix = _matrix(child) * above
            try:
                curves = _curves(_path(child, kind, matrix), factor, tolerance)
                yield Part(inside, curves, title or (names or [""])[0], said)
            except ValueError as error:
                yield Part(inside, fault=str(error))


def _matrix(element: Element) -> Matrix:
    """Give how an element is moved, refused where that is not told in full: passed over, it would be drawn somewhere else."""
    style, transform = _style(element), element.get("transform", "")
    for name in FROM_STYLE:
        if name in style or (name.startswith("transform-") and name in element.attrib):
            raise ValueError(f"shapes must be moved by an attribute transform alone, got {name}")
    if len(transform) > LONGEST_TRANSFORM:
        raise ValueError(f"transform must be at most {LONGEST_TRANSFORM} characters, got {len(transform)}")
    if not TRANSFORM.fullmatch(transform):
        raise ValueError(f"transform must be one or more of {KNOWN}, got {transform!r:.40}")
    return Matrix(transform)


def _pairs(points: str) -> list[tuple[float, float]]:
    numbers = [_number("points", word) for word in points.replace(",", " ").split()]
    if len(numbers) % 2:
        raise ValueError(f"points must be pairs of numbers, got {len(numbers)} numbers")
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def _style(element: Element) -> dict[str, str]:
    pairs = (rule.partition(":") for rule in element.get("style", "").split(";"))
    return {name.strip().lower(): value.strip() for name, _, value in pairs}


def _path(element: Element, kind: str, matrix: Matrix) -> Path:
    try:
        if kind == "path":
            shape: Any = Path(element.get("d", ""))
        elif kind in POINTED:
            shape = POINTED[kind](_pairs(element.get("points", "")))
        else:
            shape = ROUND[kind](
                **{name: _number(name, element.get(name, "0")) for name in NUMBERS if name in element.attrib}
            )
        return abs(Path(shape) * matrix)
    except (ValueError, IndexError, TypeError, AttributeError, ZeroDivisionError) as error:
        raise ValueError(f"a {kind} must be well formed, got {error or type(error).__name__}") from None


def _curves(path: Path, factor: float, tolerance: float) -> tuple[Curve, ...]:
    subpaths = [
        [segment for segment in Path(subpath) if not isinstance(segment, Move)] for subpath in path.as_subpaths()
    ]
    curves = tuple(_curve(segments, factor, tolerance) for segments in subpaths if segments)
    if not curves:
        raise ValueError("a shape must bound something, got nothing")
    return curves


def _curve(segments: list[Any], factor: float, tolerance: float) -> Curve:
    points, bulges, exact = [], [], True
    for segment in segments:
        if isinstance(segment, Arc) and isclose(segment.rx, segment.ry, rel_tol=CIRCULAR):
            # Halves: of nearly a whole circle the bulge would be without measure.
            count, bulge = 2, tan(segment.sweep / 8)
        else:
            count, bulge = 1 if isinstance(segment, Line | Close) else _edges(segment, tolerance / factor / 2), 0.0
            exact = exact and count == 1
        points.append(segment.npoint(np.arange(count) / count))
        bulges += [bulge] * count
    end = segments[-1].end
    ring = factor * np.concatenate([*points, [(end.x, end.y)]])
    apart = float(np.hypot(*(ring[-1] - ring[0])))
    if not isinstance(segments[-1], Close) and not apart <= CIRCULAR * max(np.abs(ring).max(), 1.0):
        raise ValueError(f"curve must be closed, got ends {apart:g} mm apart, at ({ring[0][0]:g}, {ring[0][1]:g}) mm")
    return tidy(ring[:-1], np.array(bulges), exact)


def _edges(segment: Any, sagitta: float) -> int:
    """Give into how many edges a curve is cut: with n of them it is within max |second derivative| / (8 n^2) of each."""
    if isinstance(segment, Arc):
        bend = segment.sweep**2 * max(segment.rx, segment.ry)
    elif isinstance(segment, QuadraticBezier):
        bend = 2 * abs(segment.start - 2 * segment.control + segment.end)
    else:
        assert isinstance(segment, CubicBezier)
        first, second = segment.control1, segment.control2
        bend = 6 * max(abs(segment.start - 2 * first + second), abs(first - 2 * second + segment.end))
    # What is not finite is refused with its points.
    count = max(2, ceil(sqrt(bend / (8 * sagitta)))) if isfinite(bend) else 2
    refuse_too_many(count)
    return count
