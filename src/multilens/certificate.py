"""The proof that a layout is feasible, in exact rational arithmetic on the decimals that are stored.

Nothing here is shared with the search: no tensors, no tolerances, no square roots. Every distance is compared by its square.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt

from multilens.back import Back
from multilens.geometry.shape import Shape
from multilens.layout import Layout
from multilens.lens import Lens

Point = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Clearance:
    """How far a lens is from the nearest thing of one kind.

    Args:
        what: the two things: "lens 1 to lens 2", "lens 3 to flash", "lens 1 within outline", "aperture of lens 2".
        room: distance beyond what is required, mm, rounded for reading.
        kept: whether it is >= 0, exactly.
    """

    what: str
    room: float
    kept: bool


@dataclass(frozen=True)
class Certificate:
    """Every constraint of a layout, checked exactly.

    Args:
        clearances: one for each constraint.
    """

    clearances: tuple[Clearance, ...]

    @property
    def feasible(self) -> bool:
        """Whether all constraints are kept at tolerance 0."""
        return all(clearance.kept for clearance in self.clearances)

    @property
    def tightest(self) -> Clearance:
        """The broken constraint, or else the one, with the least room."""
        return min(self.clearances, key=lambda clearance: (clearance.kept, clearance.room))


def certify(
    back: Back,
    lenses: Sequence[Lens],
    focus_range: Sequence[tuple[float, float]],
    layout: Layout,
    gap: float,
) -> Certificate:
    """Check a layout against every constraint, exactly.

    A number counts as the shortest decimal that reads back as the same float, which is what a JSON file stores. The body of
    lens i is the disc of radius A_i + clearance_i.

    Args:
        back: where lenses may stand.
        lenses: what is known of each.
        focus_range: nearest and farthest focus of each, mm.
        layout: one layout, not a batch.
        gap: distance that bodies keep from each other, mm.
    """
    centre: list[Point] = [(_exact(x), _exact(y)) for x, y in layout.position.tolist()]
    aperture = [_exact(radius) for radius in layout.aperture_radius.tolist()]
    body = [radius + _exact(lens.clearance) for radius, lens in zip(aperture, lenses, strict=True)]
    names = [f"lens {i + 1}" for i in range(len(lenses))]
    found = []
    for i, lens in enumerate(lenses):
        low, high = (_exact(bound) for bound in lens.aperture_radius)
        found.append(_difference(f"aperture of {names[i]}", min(aperture[i] - low, high - aperture[i])))
        near, far = (_exact(bound) for bound in focus_range[i])
        foci = [_exact(focus) for focus in layout.focus[i].tolist()]
        found.append(_difference(f"focus of {names[i]}", min(min(focus - near, far - focus) for focus in foci)))
        for place, lock in zip(centre[i], lens.position or (None, None), strict=True):
            if lock is not None:
                found.append(_difference(f"{names[i]} in its place", -abs(place - _exact(lock))))
        found.append(_within(f"{names[i]} within outline", centre[i], body[i], back.outline))
        for keep_out in back.keep_outs:
            reach = body[i] + _exact(keep_out.clearance)
            found.append(_clear_of(f"{names[i]} to {keep_out.name}", centre[i], reach, keep_out.shape))
        for j in range(i):
            apart = body[i] + body[j] + _exact(gap)
            found.append(_at_least(f"{names[j]} to {names[i]}", _square_distance(centre[i], centre[j]), apart))
    return Certificate(tuple(found))


def _within(what: str, centre: Point, body: Fraction, outline: Shape) -> Clearance:
    edges, radius = _edges(outline), _exact(outline.radius)
    nearest = min(_square_distance_to_edge(centre, edge) for edge in edges)
    if _encloses(edges, centre):
        return _at_least(what, nearest, body - radius)
    # Off the core only its round rim is left to stand on: as far from the core as the corner's radius is larger than the body.
    return _at_most(what, nearest, radius - body)


def _clear_of(what: str, centre: Point, reach: Fraction, shape: Shape) -> Clearance:
    edges, radius = _edges(shape), _exact(shape.radius)
    nearest = min(_square_distance_to_edge(centre, edge) for edge in edges)
    if _encloses(edges, centre):
        return Clearance(what, -sqrt(nearest) - float(radius + reach), False)
    return _at_least(what, nearest, radius + reach)


def _at_least(what: str, square: Fraction, required: Fraction) -> Clearance:
    return Clearance(what, sqrt(square) - float(required), required <= 0 or square >= required**2)


def _at_most(what: str, square: Fraction, allowed: Fraction) -> Clearance:
    return Clearance(what, float(allowed) - sqrt(square), allowed >= 0 and square <= allowed**2)


def _difference(what: str, room: Fraction) -> Clearance:
    return Clearance(what, float(room), room >= 0)


def _exact(number: float) -> Fraction:
    return Fraction(repr(float(number)))


def _edges(shape: Shape) -> list[tuple[Point, Point]]:
    return [((_exact(a), _exact(b)), (_exact(c), _exact(d))) for (a, b), (c, d) in shape.segments.tolist()]


def _square_distance(a: Point, b: Point) -> Fraction:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def _square_distance_to_edge(point: Point, edge: tuple[Point, Point]) -> Fraction:
    (x0, y0), (x1, y1) = edge
    along_x, along_y = x1 - x0, y1 - y0
    length = along_x**2 + along_y**2
    share = ((point[0] - x0) * along_x + (point[1] - y0) * along_y) / length if length else Fraction(0)
    share = min(max(share, Fraction(0)), Fraction(1))
    return _square_distance(point, (x0 + share * along_x, y0 + share * along_y))


def _encloses(edges: list[tuple[Point, Point]], point: Point) -> bool:
    """Whether closed rings enclose a point, by the parity of the edges crossed on the way out along x."""
    x, y = point
    crossed = 0
    for (x0, y0), (x1, y1) in edges:
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            crossed += 1
    return crossed % 2 == 1
