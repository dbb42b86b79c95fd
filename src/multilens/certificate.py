"""The proof that a layout is feasible, in exact rational arithmetic on the decimals that are stored.

Nothing here is shared with the search: no tensors, no tolerances, no square roots. Every distance is compared by its square.
Floats only leave out edges that are proved not to matter; all that is claimed is computed from the rest, exactly.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt

import numpy as np

from multilens.back import Back
from multilens.geometry.exact import Point, Side, exact, sides, square_distance
from multilens.layout import Layout
from multilens.lens import Lens


@dataclass(frozen=True)
class Clearance:
    """How far a lens is from the nearest thing of one kind.

    Args:
        what: the two things: "lens 1 to lens 2", "lens 3 to flash", "lens 1 within outline", "aperture of lens 2".
        room: distance beyond what is required, mm, rounded for reading.
        kept: whether it is >= 0, exactly.
        between_things: whether it is a distance on the back; else it is the bound of an aperture, a focus or a locked place.
    """

    what: str
    room: float
    kept: bool
    between_things: bool = True


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

    @property
    def closest(self) -> Clearance:
        """The least distance on the back: which two things come nearest to touching."""
        return min((each for each in self.clearances if each.between_things), key=lambda each: each.room)


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
    centre: list[Point] = [(exact(x), exact(y)) for x, y in layout.position.tolist()]
    aperture = [exact(radius) for radius in layout.aperture_radius.tolist()]
    body = [radius + exact(lens.clearance) for radius, lens in zip(aperture, lenses, strict=True)]
    names = [f"lens {i + 1}" for i in range(len(lenses))]
    places = np.asarray(layout.position.tolist(), dtype=np.float64)
    in_outline = sides(back.outline.segments, places)
    by_keep_out = [sides(keep_out.shape.segments, places) for keep_out in back.keep_outs]
    found = []
    for i, lens in enumerate(lenses):
        low, high = (exact(bound) for bound in lens.aperture_radius)
        found.append(_difference(f"aperture of {names[i]}", min(aperture[i] - low, high - aperture[i])))
        near, far = (exact(bound) for bound in focus_range[i])
        foci = [exact(focus) for focus in layout.focus[i].tolist()]
        found.append(_difference(f"focus of {names[i]}", min(min(focus - near, far - focus) for focus in foci)))
        for place, lock in zip(centre[i], lens.position or (None, None), strict=True):
            if lock is not None:
                found.append(_difference(f"{names[i]} in its place", -abs(place - exact(lock))))
        found.append(_within(f"{names[i]} within outline", in_outline[i], body[i], exact(back.outline.radius)))
        for keep_out, side in zip(back.keep_outs, by_keep_out, strict=True):
            reach = body[i] + exact(keep_out.clearance) + exact(keep_out.shape.radius)
            found.append(_clear_of(f"{names[i]} to {keep_out.name}", side[i], reach))
        for j in range(i):
            apart = body[i] + body[j] + exact(gap)
            found.append(_at_least(f"{names[j]} to {names[i]}", square_distance(centre[i], centre[j]), apart))
    return Certificate(tuple(found))


def _within(what: str, core: Side, body: Fraction, radius: Fraction) -> Clearance:
    if core.enclosed:
        return _at_least(what, core.square, body - radius)
    # Off the core only its round rim is left to stand on: as far from the core as the corner's radius is larger than the body.
    return _at_most(what, core.square, radius - body)


def _clear_of(what: str, core: Side, reach: Fraction) -> Clearance:
    if core.enclosed:
        return Clearance(what, -sqrt(core.square) - float(reach), False)
    return _at_least(what, core.square, reach)


def _at_least(what: str, square: Fraction, required: Fraction) -> Clearance:
    return Clearance(what, sqrt(square) - float(required), required <= 0 or square >= required**2)


def _at_most(what: str, square: Fraction, allowed: Fraction) -> Clearance:
    return Clearance(what, float(allowed) - sqrt(square), allowed >= 0 and square <= allowed**2)


def _difference(what: str, room: Fraction) -> Clearance:
    return Clearance(what, float(room), room >= 0, between_things=False)
