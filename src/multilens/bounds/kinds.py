"""Lenses of a question in the terms of the bounds: those that are alike together, their apertures on a scale of nodes."""

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from jaxtyping import Bool, Float, Int

from multilens.back import Back
from multilens.bounds.room import Reach, largest_body, most_apart
from multilens.constraints import room_at
from multilens.cues import NANOMETRE
from multilens.lens import Lens
from multilens.problem import Problem

NODES = 1025
"""Apertures from the smallest to the largest at which what depends on them is tabled."""


@dataclass(frozen=True, eq=False)
class Kind:
    """Lenses that may stand for each other: alike and free; a locked lens is a kind of its own.

    Args:
        lens: what is known of each.
        columns: the place of each among all lenses, first and one beyond the last.
        aperture: A at each node, mm, ascending; one node if it is fixed.
        focus_range: nearest and farthest focus, mm.
        reach: of a centre, for the body at each node.
    """

    lens: Lens
    columns: tuple[int, int]
    aperture: Float[np.ndarray, " a"]
    focus_range: tuple[float, float]
    reach: Reach

    @property
    def count(self) -> int:
        """How many lenses."""
        return self.columns[1] - self.columns[0]

    @property
    def body(self) -> Float[np.ndarray, " a"]:
        """Radius of the body at each node, mm."""
        return self.aperture + self.lens.clearance

    @property
    def effective_aperture(self) -> Float[np.ndarray, " a"]:
        """2 A f / blur noise at each node, mm."""
        return 2 * self.aperture * (self.lens.focal_length / self.lens.blur_noise)

    @property
    def angular_noise(self) -> float:
        """Of the disparity, rad."""
        return self.lens.disparity_noise / self.lens.focal_length


def kinds_of(problem: Problem) -> tuple[Kind, ...] | None:
    """Give the kinds of a question's lenses; None where one has no room even at its smallest aperture."""
    groups: list[tuple[Lens, tuple[float, float], int]] = []
    for lens, focus_range in zip(problem.lenses, problem.focus_range, strict=True):
        alike = [i for i, (other, *_) in enumerate(groups) if other == lens and not _place(lens)]
        if alike:
            groups[alike[0]] = (lens, focus_range, groups[alike[0]][2] + 1)
        else:
            groups.append((lens, focus_range, 1))
    widest = largest_body(problem.back)
    kinds: list[Kind] = []
    column = 0
    for lens, focus_range, count in groups:
        place = _place(lens)
        room = widest if place is None else _room(problem.back, place)
        least, most = lens.aperture_radius[0], min(lens.aperture_radius[1], room - lens.clearance)
        if most < least:
            return None
        aperture = np.linspace(least, most, NODES if most > least * (1 + 1e-9) else 2)
        if most == least:
            aperture = aperture[:1]
        body = aperture + lens.clearance
        reach = Reach.free(problem.back, body) if place is None else Reach.locked(problem.back, place, body)
        kinds.append(Kind(lens, (column, column + count), aperture, focus_range, reach))
        column += count
    return tuple(kinds)


def ordered(
    kinds: tuple[Kind, ...], low: Int[np.ndarray, "m n"], high: Int[np.ndarray, "m n"]
) -> tuple[Int[np.ndarray, "m n"], Int[np.ndarray, "m n"]]:
    """Narrow boxes of nodes to lenses in falling order of aperture within a kind: any layout can be renumbered so."""
    low, high = low.copy(), high.copy()
    for kind in kinds:
        own = slice(*kind.columns)
        low[:, own] = np.maximum.accumulate(low[:, own][:, ::-1], axis=1)[:, ::-1]
        high[:, own] = np.minimum.accumulate(high[:, own], axis=1)
    return low, high


def bodies(kinds: tuple[Kind, ...], node: Int[np.ndarray, "m n"]) -> Float[np.ndarray, "m n"]:
    """Give the radii of all bodies at their nodes, mm."""
    return np.concatenate([kind.body[node[:, slice(*kind.columns)]] for kind in kinds], axis=1)


def pairs_of(
    kinds: tuple[Kind, ...], low: Int[np.ndarray, "m n"], gap: float
) -> tuple[Float[np.ndarray, " m"], Bool[np.ndarray, " m"]]:
    """Give the longest effective baseline, mm, and which boxes have two lenses that find no room beside each other.

    Of a kind, whose lenses stand in falling order, the smallest two can stand farthest apart, and the largest two need most room.

    Args:
        kinds: of all lenses.
        low: node of the smallest aperture of each, in order.
        gap: that bodies keep from each other, mm.
    """
    baseline = np.zeros(len(low))
    crowded = np.zeros(len(low), dtype=bool)
    for one, other in combinations_with_replacement(kinds, 2):
        if one is other and one.count < 2:
            continue
        noise = np.sqrt((one.angular_noise**2 + other.angular_noise**2) / 2)
        smallest = low[:, one.columns[1] - 1], low[:, other.columns[1] - (2 if one is other else 1)]
        apart = most_apart(one.reach.support[smallest[0]], other.reach.support[smallest[1]])
        baseline = np.maximum(baseline, np.maximum(apart, NANOMETRE) / noise)
        largest = low[:, one.columns[0]], low[:, other.columns[0] + (1 if one is other else 0)]
        apart = most_apart(one.reach.support[largest[0]], other.reach.support[largest[1]])
        crowded |= one.body[largest[0]] + other.body[largest[1]] + gap > apart
    return baseline, crowded


def _place(lens: Lens) -> tuple[float, float] | None:
    x, y = lens.position or (None, None)
    return None if x is None or y is None else (x, y)


def _room(back: Back, place: tuple[float, float]) -> float:
    return float(room_at(back, np.array([place[0]]), np.array([place[1]]))[0]) + 1e-9 * back.size
