"""The room that a back leaves around many points, in NumPy, each limit with its gradient: what the peers know of a back."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from shapely import Point, Polygon

import multilens as ml
from multilens.geometry.shape import Shape

FAR = 1e3
"""mm; room that stands for an edge which limits nothing from where a lens is."""

TINY = 1e-12
"""mm; the least distance that a direction is divided by."""

Rooms = tuple[Float[np.ndarray, "m k"], Float[np.ndarray, "m k 2"]]
"""The radius that each limit leaves, mm, and where it grows."""


class Walls:
    """The limits of a back that leave points least room: a fixed number of them, so that SLSQP can take each as a constraint.

    Args:
        back: where lenses may stand; its keep-outs have convex cores.
        most: limits that are given for each point, those that leave least room.
    """

    def __init__(self, back: ml.Back, most: int = 5) -> None:
        self.sides: list[Callable[[np.ndarray], Rooms]] = _outline_sides(back.outline)
        discs = [keep for keep in back.keep_outs if isinstance(keep.shape.core, Point)]
        if discs:
            self.sides.append(_Discs([(keep.shape, keep.clearance) for keep in discs]))
        self.sides += [_Outside(keep.shape, keep.clearance) for keep in back.keep_outs if keep not in discs]
        self.most = most

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        """Give the room that the nearest limits leave around points, mm, and its gradients."""
        found = [side(point) for side in self.sides]
        room, gradient = found[0]
        if len(found) > 1:
            room = np.concatenate([room for room, _ in found], axis=1)
            gradient = np.concatenate([gradient for _, gradient in found], axis=1)
        if room.shape[1] <= self.most:
            return room, gradient
        nearest = np.argpartition(room, self.most, axis=1)[:, : self.most]
        every = np.arange(len(point))[:, None]
        return room[every, nearest], gradient[every, nearest]


def _outline_sides(outline: Shape) -> list[Callable[[np.ndarray], Rooms]]:
    core = outline.core
    if isinstance(core, Polygon) and core.equals(core.convex_hull):
        return [_Convex(outline)]
    return [_RoundRim(outline) if outline.radius else _Edges(outline)]


class _HalfPlanes:
    """The straight sides of a convex outline, each a linear constraint that also shows the way back from outside."""

    def __init__(self, outline: Shape) -> None:
        start, end = outline.segments[:, 0], outline.segments[:, 1]
        along = end - start
        normal = along[:, ::-1] * [-1.0, 1.0] / np.linalg.norm(along, axis=1, keepdims=True)
        middle = outline.segments.reshape(-1, 2).mean(0)
        self.inward = normal * np.sign(((middle - start) * normal).sum(1, keepdims=True))
        self.offset = outline.radius - (start * self.inward).sum(1)

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        room = point @ self.inward.T + self.offset
        return room, np.broadcast_to(self.inward, (len(point), *self.inward.shape))


class _Convex:
    """A convex outline: its straight sides and, where its corners are round, the rim for a point that is beyond the core."""

    def __init__(self, outline: Shape) -> None:
        self.flat, self.radius, self.segments = _HalfPlanes(outline), outline.radius, outline.segments

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        sides, inward = self.flat(point)
        if not self.radius:
            return sides, inward
        every, least = np.arange(len(point)), sides.argmin(1)
        room, gradient = sides[every, least], inward[0, least]
        beyond = np.flatnonzero(room < self.radius)
        if len(beyond):
            away, distance = _from_nearest_edge(point[beyond], self.segments)
            room[beyond] = self.radius - distance
            gradient[beyond] = -away / np.maximum(distance, TINY)[:, None]
        return np.column_stack([sides, room]), np.concatenate([inward, gradient[:, None]], axis=1)


class _RoundRim:
    """The rim of an outline whose core has no area: a disc, or a line grown by a radius."""

    def __init__(self, outline: Shape) -> None:
        self.radius, self.segments = outline.radius, outline.segments

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        away, distance = _from_nearest_edge(point, self.segments)
        return (self.radius - distance)[:, None], (-away / np.maximum(distance, TINY)[:, None])[:, None]


class _Discs:
    """Round keep-outs, to stay clear of."""

    def __init__(self, discs: list[tuple[Shape, float]]) -> None:
        self.centre = np.array([shape.core.coords[0] for shape, _ in discs])
        self.reach = np.array([shape.radius + clearance for shape, clearance in discs])

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        away = point[:, None] - self.centre
        distance = np.sqrt(np.einsum("mkx,mkx->mk", away, away))
        return distance - self.reach, away / np.maximum(distance, TINY)[..., None]


class _Edges:
    """The edges of any outline, holes and parts too; on the wrong side only the way to the nearest of them counts."""

    def __init__(self, outline: Shape) -> None:
        self.segments = outline.segments

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        away, distance = _from_edges(point, self.segments)
        inside = _is_inside(point, self.segments)[:, None]
        nearest = distance == distance.min(1, keepdims=True)
        sign = np.where(inside, 1.0, np.where(nearest, -1.0, 0.0))
        room = np.where(sign == 0, FAR, sign * distance)
        return room, (sign / np.maximum(distance, TINY))[..., None] * away


class _Outside:
    """A keep-out with a convex core of straight edges, to stay clear of."""

    def __init__(self, shape: Shape, clearance: float) -> None:
        core = shape.core
        if not core.equals(core.convex_hull):
            raise ValueError("keep-outs must have convex cores for this peer, got one with a notch")
        self.reach, self.segments = shape.radius + clearance, shape.segments
        self.flat = _HalfPlanes(Shape(core)) if core.area else None

    def __call__(self, point: Float[np.ndarray, "m 2"]) -> Rooms:
        away, distance = _from_nearest_edge(point, self.segments)
        gradient = away / np.maximum(distance, TINY)[:, None]
        if self.flat is not None:
            sides, inward = self.flat(point)
            depth, least = sides.min(1), sides.argmin(1)
            inside = depth > 0
            if inside.any():
                distance = np.where(inside, -depth, distance)
                gradient = np.where(inside[:, None], -inward[0, least], gradient)
        return (distance - self.reach)[:, None], gradient[:, None]


def _from_edges(
    point: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]
) -> tuple[Float[np.ndarray, "m e 2"], Float[np.ndarray, "m e"]]:
    """Give the vector from the nearest point of every edge, and its length, mm."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    length_squared = (along**2).sum(1)
    from_start = point[:, None] - start
    share = np.einsum("mex,ex->me", from_start, along) / np.where(length_squared > 0, length_squared, 1)
    away = from_start - np.minimum(np.maximum(share, 0), 1)[..., None] * along
    return away, np.sqrt(np.einsum("mex,mex->me", away, away))


def _from_nearest_edge(
    point: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]
) -> tuple[Float[np.ndarray, "m 2"], Float[np.ndarray, " m"]]:
    away, distance = _from_edges(point, segments)
    nearest, every = distance.argmin(1), np.arange(len(point))
    return away[every, nearest], distance[every, nearest]


def _is_inside(point: Float[np.ndarray, "m 2"], segments: Float[np.ndarray, "e 2 2"]) -> np.ndarray:
    """Tell which points rings enclose, by the parity of the edges crossed on the way out along x."""
    (x0, y0), (x1, y1) = segments[:, 0].T, segments[:, 1].T
    x, y = point[:, :1], point[:, 1:]
    rise = y1 - y0
    slope = (x1 - x0) / np.where(rise != 0, rise, 1)
    crossed = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * slope)
    return crossed.sum(1) % 2 == 1
