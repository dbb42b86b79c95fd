"""A plan as SVG in millimetres, to scale: one user unit is one millimetre, on the axes of the back."""

from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from jaxtyping import Float

from multilens.cad.curve import Curve
from multilens.cad.labels import labels
from multilens.cad.layers import APERTURES, BASELINES, BODIES, KEEP_OUTS, LABELS, OUTLINE, clean
from multilens.cad.plan import Plan
from multilens.cad.rims import bare, rims
from multilens.geometry.shape import Shape

LOOKS = {
    OUTLINE: 'fill="#ffffff" stroke="#1a1a1a" stroke-width="{wide}" fill-rule="evenodd"',
    KEEP_OUTS: 'fill="#d9d9d9" stroke="#b3261e" stroke-width="{thin}" fill-rule="evenodd"',
    BODIES: 'fill="none" stroke="#6b6b6b" stroke-width="{thin}"',
    APERTURES: 'fill="#0072b2" stroke="none"',
    BASELINES: 'fill="none" stroke="#1a1a1a" stroke-width="{thin}" stroke-dasharray="{dash} {dash}"',
    LABELS: 'fill="#1a1a1a" stroke="#ffffff" stroke-width="{wide}" paint-order="stroke" font-family="sans-serif" '
    'font-size="{text}" text-anchor="middle"',
}
"""In the order of drawing."""

BEGINS = ' text-anchor="start"'

PENS = {"thin": 0.001, "wide": 0.0025, "dash": 0.005, "text": 0.014}
"""Widths and heights as parts of the diagonal of the back: of a phone 0.18, 0.44, 0.9 and 2.5 mm."""


def write_svg(plan: Plan) -> str:
    """Give a group for each layer; circles and round corners are true arcs."""
    left, top, right, bottom = plan.extent
    pens = {name: float(f"{part * plan.back.size:.2g}") for name, part in PENS.items()}
    margin = 2 * pens["text"]
    x, y, width, height = left - margin, top - margin, right - left + 2 * margin, bottom - top + 2 * margin
    drawn = {layer: list(_drawn(plan, layer, pens["text"])) for layer in LOOKS}
    groups = [
        [f'<g id="{layer}" {LOOKS[layer].format(**pens)}>', *lines, "</g>"] for layer, lines in drawn.items() if lines
    ]
    head = f'width="{width!r}mm" height="{height!r}mm" viewBox="{x!r} {y!r} {width!r} {height!r}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" version="1.1" {head}>',
        *(line for group in groups for line in group),
    ]
    return "\n".join([*lines, "</svg>", ""])


def _drawn(plan: Plan, layer: str, text: float) -> Iterator[str]:
    stands = plan.stands
    if layer == OUTLINE:
        yield _shape(plan.back.outline, "outline", "")
    elif layer == KEEP_OUTS:
        for keep_out in plan.back.keep_outs:
            yield _shape(keep_out.shape, keep_out.name, f' data-clearance="{float(keep_out.clearance)!r}"')
    elif layer == BASELINES:
        for a, b, length in plan.baselines:
            ends = f'x1="{a.x!r}" y1="{a.y!r}" x2="{b.x!r}" y2="{b.y!r}"'
            yield f"<line {ends}>{_title(f'{a.name} to {b.name}: {length:.3f} mm')}</line>"
    elif layer == LABELS:
        for label in labels(plan, text):
            # Letters stand on a line a third of their height below their middle.
            place = f'x="{label.x!r}" y="{label.y + text / 3!r}"{"" if label.centred else BEGINS}'
            yield f"<text {place}>{escape(label.words)}</text>"
    else:
        for stand in stands:
            radius = stand.aperture_radius if layer == APERTURES else stand.body_radius
            about = f"{stand.name}: f/{stand.f_number:.3g}, focus {', '.join(f'{z:.1f}' for z in stand.foci)} mm"
            yield f'<circle cx="{stand.x!r}" cy="{stand.y!r}" r="{radius!r}">{_title(about)}</circle>'


def _shape(shape: Shape, name: str, more: str) -> str:
    curves = rims(shape)
    if len(curves) == 1 and bare(curves[0]):
        (x, y), radius = curves[0].centres[0].tolist(), float(shape.radius)
        return f'<circle cx="{x!r}" cy="{y!r}" r="{radius!r}"{more}>{_title(name)}</circle>'
    return f"<path d={quoteattr(_path(curves))}{more}>{_title(name)}</path>"


def _path(curves: Sequence[Curve]) -> str:
    words = []
    for curve in curves:
        radii = iter(curve.radii.tolist())
        words.append(f"M {_point(curve.points[0])}")
        for end, middle, bulge in zip(curve.ends, curve.middles, curve.bulges.tolist(), strict=True):
            if bulge == 0:
                words.append(f"L {_point(end)}")
                continue
            # Halves: the centre of nearly half a circle is hard to tell from its ends and its radius.
            arc = f"A {(radius := next(radii))!r} {radius!r} 0 0 {int(bulge > 0)}"
            words += [f"{arc} {_point(middle)}", f"{arc} {_point(end)}"]
        words.append("Z")
    return " ".join(words)


def _point(point: Float[np.ndarray, "2"]) -> str:
    return " ".join(map(repr, point.tolist()))


def _title(words: str) -> str:
    return f"<title>{escape(clean(words))}</title>"
