"""On which side of closed rings a point is and how far from them, in exact rational arithmetic.

Floats only choose the edges worth computing: those that may be the nearest, and those that a line from the point may cross.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from math import lcm

import numpy as np
from jaxtyping import Bool, Float

Point = tuple[Fraction, Fraction]
Edge = tuple[Point, Point]

MARGIN = 2.0**-40
"""Part of the largest coordinate. An edge whose distance in floats is larger than another's by more is left out."""

LEAST_MARGIN = 1e-100
"""mm; more than is lost where the squares of tiny numbers underflow."""


@dataclass(frozen=True)
class Side:
    """How a point lies to closed rings.

    Args:
        square: square of the distance to the nearest edge, mm^2.
        enclosed: whether the rings enclose the point, by parity; a point on an edge may count either way.
    """

    square: Fraction
    enclosed: bool


@lru_cache(maxsize=16384)
def exact(number: float) -> Fraction:
    """Give the shortest decimal that reads back as the same float, which is what a JSON file stores.

    Remembered, since layouts on one back are certified one after another: its corners and the lenses' bounds return.

    Raises:
        ValueError: the number is NaN.
        OverflowError: it is infinite.
    """
    return Fraction(Decimal(repr(float(number))))


def square_distance(a: Point, b: Point) -> Fraction:
    """Give the square of the distance of two points, mm^2."""
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def sides(segments: Float[np.ndarray, "e 2 2"], points: Float[np.ndarray, "n 2"]) -> list[Side]:
    """Give how each point lies to closed rings, exactly, every number meant as its shortest decimal.

    Args:
        segments: start and end of every edge of the rings, mm, finite and at most 1e6.
        points: mm, finite.
    """
    nearest = _may_be_nearest(segments, points)
    surely, perhaps = _crossed(segments, points)
    return [
        Side(
            min(_square_distance_to_edge(point, edge) for edge in _exact_edges(segments[near])),
            (sure + sum(_crosses(point, edge) for edge in _exact_edges(segments[doubt]))) % 2 == 1,
        )
        for point, near, sure, doubt in zip(
            [(exact(x), exact(y)) for x, y in points.tolist()], nearest, surely.sum(-1).tolist(), perhaps, strict=True
        )
    ]


def _may_be_nearest(segments: Float[np.ndarray, "e 2 2"], points: Float[np.ndarray, "n 2"]) -> Bool[np.ndarray, "n e"]:
    """Say which edges may be the nearest to each point; all others are proved to be farther than one that is named.

    With M the largest coordinate of the rings and the point, and u = 2^-53: a decimal is within u M of its float. That moves a
    distance by 3 u M at most. With w from the edge's start to the point and e along the edge, |w| <= 2 sqrt(2) M, the share
    s = w.e / e.e is computed within 9 u |w| / |e|, which moves the foot by 9 u |w| < 26 u M; w - s e adds less than
    21 u M and its length 9 u M. So a distance in floats is within 64 u M of the exact one, and two of them, compared,
    err by 128 u M = 2^-46 M at most: a 64th of the margin. Where e.e underflows the edge is shorter than the least
    margin, and any share is good enough. What is not finite leaves nothing out.
    """
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        x, y = (points[:, None, axis] - start[:, axis] for axis in (0, 1))
        length = along[:, 0] ** 2 + along[:, 1] ** 2
        share = (x * along[:, 0] + y * along[:, 1]) / np.where(length > 0, length, 1)
        share = np.clip(share, 0, 1)
        distance = np.hypot(x - share * along[:, 0], y - share * along[:, 1])
        largest = np.maximum(np.abs(points).max(-1), np.abs(segments).max())
        limit = distance.min(-1) + MARGIN * largest + LEAST_MARGIN
        return ~(distance > limit[:, None])


def _crossed(
    segments: Float[np.ndarray, "e 2 2"], points: Float[np.ndarray, "n 2"]
) -> tuple[Bool[np.ndarray, "n e"], Bool[np.ndarray, "n e"]]:
    """Say which edges the way out along x crosses surely, and which perhaps.

    Shortest decimals are in the order of their floats, and equal only where these are: comparing floats is exact.
    """
    x, y = points[:, :1], points[:, 1:]
    (x0, y0), (x1, y1) = segments[:, 0].T, segments[:, 1].T
    astride = (y0 > y) != (y1 > y)
    before = x < np.minimum(x0, x1)
    return astride & before, astride & ~before & (x < np.maximum(x0, x1))


def _exact_edges(segments: Float[np.ndarray, "e 2 2"]) -> Iterator[Edge]:
    for (a, b), (c, d) in segments.tolist():
        yield (exact(a), exact(b)), (exact(c), exact(d))


def _square_distance_to_edge(point: Point, edge: Edge) -> Fraction:
    # On whole multiples of one fraction: a rational sum would look for a common divisor at every step.
    numbers = (*point, *edge[0], *edge[1])
    unit = lcm(*[number.denominator for number in numbers])
    x, y, x0, y0, x1, y1 = [number.numerator * (unit // number.denominator) for number in numbers]
    x, y, along_x, along_y = x - x0, y - y0, x1 - x0, y1 - y0
    length, reach = along_x**2 + along_y**2, x * along_x + y * along_y
    if reach <= 0:
        return Fraction(x**2 + y**2, unit**2)
    if reach >= length:
        return Fraction((x - along_x) ** 2 + (y - along_y) ** 2, unit**2)
    return Fraction((x * along_y - y * along_x) ** 2, length * unit**2)


def _crosses(point: Point, edge: Edge) -> bool:
    """Whether the way out along x crosses an edge whose ends lie on both sides of it."""
    (x, y), ((x0, y0), (x1, y1)) = point, edge
    return x < x0 + (y - y0) * (x1 - x0) / (y1 - y0)
