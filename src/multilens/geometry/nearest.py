"""Distances of many points to many edges at once, without a gradient."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

FEW_EDGES = 12
"""As many are looked at one by one; more are first looked at in runs."""

RUN = 4
"""Neighbouring edges, or runs of them, that make a longer run."""

BLOCK = 8192
"""Points looked at together: as many as leave the numbers of a step in the processor's cache."""

ROUNDING = 2.0**-40
"""Part of the largest coordinate by which a run may seem too far and yet hold the nearest edge; far above what is rounded."""


@dataclass(frozen=True)
class _Runs:
    """Runs of edges that follow one another, each close to the straight line from its start to its end.

    Args:
        columns: that line, as `_columns` gives it.
        sag: largest distance of the run from its chord, mm; as the run is connected, that of the chord from the run, too.
        first: index of the first part of each run, among the shorter runs that it is made of, and one past the last part.
    """

    columns: Float[np.ndarray, "5 r"]
    sag: Float[np.ndarray, " r"]
    first: Int[np.ndarray, " r+1"]


def distance_to_nearest(
    points: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]
) -> Float[np.ndarray, " m"]:
    """Give the distance of each point to the nearest of many edges, mm; an edge may be a single point.

    The distance to a run of edges differs from that to its chord by its sag at most. So a run whose chord is farther than
    another's by more than both sags does not hold the nearest edge; those that are left are looked at part by part.

    Args:
        points: mm, finite.
        segments: start and end of each edge, mm, at least one; edges that follow one another share a point.
    """
    look = _look_one_by_one if len(segments) <= FEW_EDGES else _look_by_runs
    return np.concatenate([look(points[i : i + BLOCK], segments) for i in range(0, max(len(points), 1), BLOCK)])


def _look_one_by_one(points: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]) -> Float[np.ndarray, " m"]:
    return np.sqrt(np.minimum.reduce([_square_distance(points.T, column[:, None]) for column in _columns(segments).T]))


def _look_by_runs(points: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]) -> Float[np.ndarray, " m"]:
    if not len(points):
        return np.zeros(0)
    levels = _levels(segments)
    margin = ROUNDING * max(np.abs(points).max(), np.abs(segments).max())
    each, place = np.arange(len(points)), np.ascontiguousarray(points.T)
    point, run = np.repeat(each, len(levels[-1].sag)), np.tile(np.arange(len(levels[-1].sag)), len(points))
    for level in reversed(levels):
        distance = np.sqrt(_square_distance(place.take(point, 1), level.columns.take(run, 1)))
        sag = level.sag.take(run)
        nearest = np.minimum.reduceat(distance + sag, np.searchsorted(point, each))
        near = distance - sag <= nearest[point] + margin
        point, run = point[near], run[near]
        parts = level.first[run + 1] - level.first[run]
        skipped = level.first[run] - (np.cumsum(parts) - parts)
        point, run = np.repeat(point, parts), np.arange(parts.sum()) + np.repeat(skipped, parts)
    squares = _square_distance(place.take(point, 1), _columns(segments).take(run, 1))
    return np.sqrt(np.minimum.reduceat(squares, np.searchsorted(point, each)))


def _levels(segments: Float[np.ndarray, "e 2 2"]) -> list[_Runs]:
    """Give runs of edges, runs of these runs and so on, until few are left; no run goes on from one ring to the next."""
    starts_ring = np.append(True, (segments[1:, 0] != segments[:-1, 1]).any(-1))
    edge, levels = np.arange(len(segments) + 1), []
    while len(edge) - 1 > FEW_EDGES:
        starts_here = starts_ring[edge[:-1]]
        in_ring = np.arange(len(starts_here)) - np.flatnonzero(starts_here)[np.cumsum(starts_here) - 1]
        first = np.append(np.flatnonzero(in_ring % RUN == 0), len(starts_here))
        if len(first) == len(edge):
            break
        edge = edge[first]
        chord = np.stack([segments[edge[:-1], 0], segments[edge[1:] - 1, 1]], axis=1)
        columns = _columns(chord)
        off = _square_distance(segments[:, 1].T, columns.repeat(np.diff(edge), 1))
        levels.append(_Runs(columns, np.sqrt(np.maximum.reduceat(off, edge[:-1])), first))
    return levels


def _columns(segments: Float[np.ndarray, "e 2 2"]) -> Float[np.ndarray, "5 e"]:
    """Give start, direction and the inverse square of the length of each segment (0 for a point), a row each."""
    start, along = segments[:, 0].T, (segments[:, 1] - segments[:, 0]).T
    square = along[0] ** 2 + along[1] ** 2
    # A length whose square underflows is as good as none.
    inverse = np.divide(1, square, out=np.zeros_like(square), where=square >= np.finfo(square.dtype).tiny)
    return np.concatenate([start, along, inverse[None]])


def _square_distance(points: Float[np.ndarray, "2 m"], columns: Float[np.ndarray, "5 #m"]) -> Float[np.ndarray, " m"]:
    """Give the square of the distance of each point to its own segment, or to the one segment."""
    x0, y0, along_x, along_y, inverse = columns
    x, y = points[0] - x0, points[1] - y0
    share = x * along_x
    share += y * along_y
    share *= inverse
    np.maximum(share, 0, out=share)
    np.minimum(share, 1, out=share)
    x -= share * along_x
    y -= share * along_y
    x *= x
    y *= y
    x += y
    return x
