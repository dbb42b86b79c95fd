"""Where labels go so that they cover neither each other nor what they label: plain geometry on the paper, in points."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import cos, hypot, pi, sin

HARD = 1000.0
"""Cost of covering a label or a lens; anything else a label may cover costs less than this in all."""

RANK_COST = 0.02
"""Cost of a place for every place that is preferred to it."""

GAP = 1.5
"""Space that labels keep, points: text is measured a little differently by every way to draw it."""


@dataclass(frozen=True)
class Box:
    """An upright rectangle on the paper.

    Args:
        x: of its centre, points to the right of the top left corner.
        y: of its centre, points down.
        width: points.
        height: points.
    """

    x: float
    y: float
    width: float
    height: float

    def covers(self, other: "Box") -> bool:
        """Tell whether two boxes share any area."""
        apart_x, apart_y = abs(self.x - other.x), abs(self.y - other.y)
        return apart_x < (self.width + other.width) / 2 and apart_y < (self.height + other.height) / 2

    def within(self, other: "Box") -> bool:
        """Tell whether this box lies wholly in the other."""
        in_x = abs(self.x - other.x) <= (other.width - self.width) / 2
        return in_x and abs(self.y - other.y) <= (other.height - self.height) / 2

    def distance(self, x: float, y: float) -> float:
        """Give the distance of a point to the box, points; 0 inside."""
        return hypot(max(abs(x - self.x) - self.width / 2, 0), max(abs(y - self.y) - self.height / 2, 0))

    def meets(self, start: tuple[float, float], end: tuple[float, float]) -> bool:
        """Tell whether a straight line between two points passes through the box, by clipping it side by side."""
        enters, leaves = 0.0, 1.0
        for k, (middle, side) in enumerate(((self.x, self.width), (self.y, self.height))):
            along, before, after = end[k] - start[k], middle - side / 2 - start[k], middle + side / 2 - start[k]
            if along == 0:
                if before > 0 or after < 0:
                    return False
                continue
            near, far = sorted((before / along, after / along))
            enters, leaves = max(enters, near), min(leaves, far)
        return enters < leaves

    def grown(self, by: float) -> "Box":
        """Give the box larger by so much on every side."""
        return Box(self.x, self.y, self.width + 2 * by, self.height + 2 * by)


@dataclass(frozen=True)
class Disc:
    """A disc on the paper, in points."""

    x: float
    y: float
    radius: float


@dataclass
class Paper:
    """What is on the paper already, and what a further label pays for covering it.

    Args:
        edge: no label leaves it.
        boxes: labels, which nothing may cover.
        discs: lenses, which nothing may cover.
        soft: give what a label at some place pays for covering something better left uncovered.
    """

    edge: Box
    boxes: list[Box] = field(default_factory=list)
    discs: list[Disc] = field(default_factory=list)
    soft: list[Callable[[Box], float]] = field(default_factory=list)

    def hard_cost(self, box: Box) -> float:
        """Give what a label at this place would pay for covering labels and lenses; infinite off the paper."""
        if not box.within(self.edge):
            return float("inf")
        near = box.grown(GAP)
        hard = sum(near.covers(other) for other in self.boxes)
        hard += sum(near.distance(disc.x, disc.y) < disc.radius for disc in self.discs)
        return HARD * hard

    def soft_cost(self, box: Box) -> float:
        """Give what a label at this place would pay for covering things that may be covered."""
        return sum(cost(box.grown(GAP)) for cost in self.soft)

    def crossing_cost(self, start: tuple[float, float], end: tuple[float, float]) -> float:
        """Give what a leader between two points pays for the labels and lenses that it crosses past its start."""
        cost = sum(100.0 for box in self.boxes if box.grown(GAP).meets(start, end))
        for disc in self.discs:
            if hypot(start[0] - disc.x, start[1] - disc.y) >= disc.radius:
                # The square in the disc: a leader may brush its rim.
                side = disc.radius * 2**0.5
                cost += 50.0 * Box(disc.x, disc.y, side, side).meets(start, end)
        return cost

    def place(
        self, width: float, height: float, candidates: Sequence[tuple[float, float]], anchor: tuple[float, float]
    ) -> Box:
        """Take the cheapest of the places for a label and keep it for this label.

        Args:
            width: of the label, points.
            height: points.
            candidates: centres, the preferred first; at least one. A later one must save something to be taken.
            anchor: the point that the label speaks of; a leader to it must not cross others.

        Returns:
            The place; where all are off the paper the first, pushed back onto it.
        """
        best, least = None, float("inf")
        for rank, (x, y) in enumerate(candidates):
            if RANK_COST * rank >= least:
                break
            box = Box(x, y, width, height)
            cost = RANK_COST * rank + self.hard_cost(box)
            # What is dear to find out is asked last, and only of places that still may be the best.
            if cost < least:
                cost += self.crossing_cost(anchor, leader_end(box, anchor))
            if cost < least:
                cost += self.soft_cost(box)
            if cost < least:
                best, least = box, cost
        chosen = best or _pushed_in(Box(*candidates[0], width, height), self.edge)
        self.boxes.append(chosen)
        return chosen


def leader_end(box: Box, anchor: tuple[float, float]) -> tuple[float, float]:
    """Give the point of the box nearest to what it labels, where a leader ends."""
    x = min(max(anchor[0], box.x - box.width / 2), box.x + box.width / 2)
    y = min(max(anchor[1], box.y - box.height / 2), box.y + box.height / 2)
    return x, y


def around(
    anchor: tuple[float, float], radius: float, width: float, height: float, reach: float
) -> Iterator[tuple[float, float]]:
    """Give centres for a label around a disc, those that touch it first, going outwards as far as `reach` points."""
    distance = radius + 2 * GAP
    while distance <= radius + reach:
        for k in range(24):
            # Right, left, below and above come first within a ring, the slanted ones after.
            angle = 2 * pi * ((k * 6) % 24 + (k * 6) // 24) / 24
            x, y = cos(angle), sin(angle)
            yield anchor[0] + x * (distance + width / 2), anchor[1] + y * (distance + height / 2)
        distance += 6.0


def spread(wanted: Sequence[float], widths: Sequence[float], start: float, end: float) -> list[float] | None:
    """Move labels along a line, in their order and as little as need be, until none covers another.

    Neighbours that touch move as one, to the mean of where each would be: the least-squares answer.

    Args:
        wanted: where each centre should be, ascending.
        widths: of the labels, the space between them included.
        start: of the line.
        end: of the line.

    Returns:
        The centres, or None where the labels are longer than the line.
    """
    if sum(widths) > end - start:
        return None
    blocks: list[tuple[float, float, int]] = []  # left edge, width, number of labels
    offsets: list[list[float]] = []  # left edge that each label wants for its block
    for centre, width in zip(wanted, widths, strict=True):
        block, lefts = (centre - width / 2, width, 1), [centre - width / 2]
        block = (min(max(block[0], start), end - width), width, 1)
        while blocks and blocks[-1][0] + blocks[-1][1] > block[0]:
            before, before_lefts = blocks.pop(), offsets.pop()
            lefts = before_lefts + [left - before[1] for left in lefts]
            whole = before[1] + block[1]
            left = min(max(sum(lefts) / len(lefts), start), end - whole)
            block = (left, whole, before[2] + block[2])
        blocks.append(block)
        offsets.append(lefts)
    centres: list[float] = []
    for left, _, count in blocks:
        for width in widths[len(centres) : len(centres) + count]:
            centres.append(left + width / 2)
            left += width
    return centres


def _pushed_in(box: Box, edge: Box) -> Box:
    room_x, room_y = max(edge.width - box.width, 0) / 2, max(edge.height - box.height, 0) / 2
    x = min(max(box.x, edge.x - room_x), edge.x + room_x)
    y = min(max(box.y, edge.y - room_y), edge.y + room_y)
    return Box(x, y, box.width, box.height)
