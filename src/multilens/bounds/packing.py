"""Which radii cannot be packed: proofs for many boxes of radii at once.

A box of radii is out of the question when its smallest radii are. Nothing here proves that radii do fit.
"""

from dataclasses import dataclass
from itertools import combinations, permutations
from math import pi

import numpy as np
from jaxtyping import Bool, Float

SAFE = 1e-9
"""Relative; by how much room must be missing before it counts, and by which bodies may stand closer: roots magnify rounding."""

MOST_ORDERED = 4
"""Bodies, the largest, that are looked at in every order; all orders of more would be too many."""


def florian_density(ratio: Float[np.ndarray, " m"]) -> Float[np.ndarray, " m"]:
    """Give the density that no packing of the plane exceeds when the smallest radius is `ratio` times the largest.

    s(q) = (pi q^2 + 2 (1 - q^2) arcsin(q / (1 + q))) / (2 q sqrt(2 q + 1)), falling from 1 to pi / sqrt(12).

    Args:
        ratio: q, 0 < q <= 1.

    Reference:
        A. Florian, Ausfuellung der Ebene durch Kreise, Rendiconti del Circolo Matematico di Palermo 9 (1960).
    """
    q = ratio
    return (pi * q**2 + 2 * (1 - q**2) * np.arcsin(q / (1 + q))) / (2 * q * np.sqrt(2 * q + 1))


@dataclass(frozen=True)
class Space:
    """What bodies share.

    Args:
        gap: that bodies keep from each other, mm.
        body_area: that bodies grown by half the gap can cover together, mm^2.
        box_area: of a box around the back, grown likewise, mm^2.
        sides: of the box around the back, mm.
        round_radius: of a round back, mm; None for others.
    """

    gap: float
    body_area: float
    box_area: float
    sides: tuple[float, float]
    round_radius: float | None

    def coverable(self, low: Float[np.ndarray, "m n"], high: Float[np.ndarray, "m n"]) -> Float[np.ndarray, " m"]:
        """Give the area that bodies of radii from low to high, grown by half the gap, cover at most, mm^2."""
        half = self.gap / 2
        ratio = (low.min(1) + half) / (high.max(1) + half)
        return np.minimum(self.body_area, self.box_area * florian_density(ratio))

    def crowded(self, low: Float[np.ndarray, "m n"], high: Float[np.ndarray, "m n"]) -> Bool[np.ndarray, " m"]:
        """Say for which boxes of radii, mm, the areas or the rings of their bodies prove that nothing fits."""
        covered = (pi * (low + self.gap / 2) ** 2).sum(1)
        crowded = covered > self.coverable(low, high) * (1 + SAFE)
        largest_first = -np.sort(-low, axis=1)
        for count in range(2, min(low.shape[1], MOST_ORDERED) + 1):
            largest = largest_first[:, :count]
            for across, along in (self.sides, self.sides[::-1]):
                crowded |= ladder_length(largest, across, self.gap) > along * (1 + SAFE)
            if self.round_radius is not None and count > 2:
                crowded |= ring_turn(largest, self.round_radius, self.gap) > 2 * pi * (1 + SAFE)
        return crowded


def ladder_length(radii: Float[np.ndarray, "m n"], across: float, gap: float) -> Float[np.ndarray, " m"]:
    """Give the least length of a strip of a given width that bodies take up, mm; in a shorter one none of their orders fits.

    Two centres are at least d = r_i + r_j + gap apart and at most `across` - r_i - r_j across the strip, so along it they differ
    by sqrt(d^2 - (across - r_i - r_j)^2) or more. In the order of their centres along the strip each is as far on as all before
    it force it to be.

    Args:
        radii: of the bodies, mm.
        across: width of the strip, mm.
        gap: that bodies keep from each other, mm.
    """
    count = radii.shape[1]
    apart = {}
    for i, j in combinations(range(count), 2):
        together = radii[:, i] + radii[:, j]
        beside = np.maximum(across - together, 0.0)
        apart[i, j] = apart[j, i] = np.sqrt(np.maximum(((together + gap) * (1 - SAFE)) ** 2 - beside**2, 0.0))
    lengths = []
    for order in permutations(range(count)):
        if order[0] > order[-1]:
            continue
        along: list[Float[np.ndarray, " m"]] = []
        for place, i in enumerate(order):
            forced = [along[before] + apart[order[before], i] for before in range(place)]
            along.append(np.maximum.reduce([radii[:, i], *forced]))
        lengths.append(np.maximum.reduce([at + radii[:, i] for at, i in zip(along, order, strict=True)]))
    return np.minimum.reduce(lengths)


def least_angle(
    first: Float[np.ndarray, " m"], second: Float[np.ndarray, " m"], round_radius: float, gap: float
) -> Float[np.ndarray, " m"]:
    """Give the least angle at which two bodies can be seen from the middle of a round back, rad.

    Centres at distances x and y from the middle and d or more apart are seen at an angle with
    cos = (x^2 + y^2 - d^2) / (2 x y) or less. Where neither x nor y can exceed d, this grows with both, so the least angle is
    that of both bodies at the rim. Where one can, the bodies may stand behind each other, at an angle of 0.

    Args:
        first: radii of the one body, mm.
        second: of the other, mm.
        round_radius: of the back, mm.
        gap: that the bodies keep from each other, mm.
    """
    x, y = np.maximum(round_radius - first, 0.0), np.maximum(round_radius - second, 0.0)
    apart = first + second + gap
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (x**2 + y**2 - (apart * (1 - SAFE)) ** 2) / (2 * x * y)
    # A body that fills the back stands in the middle, where angles mean nothing.
    known = (x <= apart) & (y <= apart) & (x > 0) & (y > 0)
    return np.where(known, np.arccos(np.clip(np.where(known, cosine, 1.0), -1.0, 1.0)), 0.0)


def ring_turn(radii: Float[np.ndarray, "m n"], round_radius: float, gap: float) -> Float[np.ndarray, " m"]:
    """Give the least turn around the middle of a round back that bodies take up one after the other, rad; above 2 pi none fit.

    Seen from the middle the centres have some order around it, and the angles from each to the next add up to one turn.

    Args:
        radii: of at least three bodies, mm.
        round_radius: of the back, mm.
        gap: that bodies keep from each other, mm.
    """
    count = radii.shape[1]
    angle = {}
    for i, j in combinations(range(count), 2):
        angle[i, j] = angle[j, i] = least_angle(radii[:, i], radii[:, j], round_radius, gap)
    turns = []
    for order in permutations(range(1, count)):
        if order[0] < order[-1]:
            around = (0, *order)
            turns.append(sum(angle[i, j] for i, j in zip(around, (*order, 0), strict=True)))
    return np.minimum.reduce(turns)
