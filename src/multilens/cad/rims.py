"""From a shape to the curves of its rim, to be drawn."""

from math import acos, atan2, ceil, pi, tan

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from multilens.cad.curve import Curve, circle
from multilens.geometry.shape import Shape

OUTWARD = 1e-3
"""mm; by no more are rims that are not arcs about a convex core drawn outside the true one."""

STRAIGHT_ON = 1e-12
"""Radians; a core that turns by less has no corner there."""


def rims(shape: Shape) -> list[Curve]:
    """Give the curves that bound a shape, with true arcs for round corners.

    Only keep-outs may be grown from a core with notches or holes. Their rims are cut into edges that lie outside, by at most
    `OUTWARD`.

    Returns:
        Curves, mm; shells and holes alike: what an odd number of them enclose is inside.
    """
    if is_round(shape):
        return [_grown(shape.core.convex_hull, shape.radius)]
    rings = shapely.get_parts(straight(shape).boundary)
    return [Curve(points := shapely.get_coordinates(ring)[:-1], np.zeros(len(points))) for ring in rings]


def is_round(shape: Shape) -> bool:
    """Whether the rim of a shape is one curve with true arcs."""
    return shape.radius > 0 and shape.core.equals(shape.core.convex_hull)


def straight(shape: Shape) -> BaseGeometry:
    """Give a shape that is not round as a polygon: itself, or one that holds it and is larger by at most `OUTWARD`."""
    if shape.radius == 0:
        return shape.core
    radius = shape.radius + OUTWARD
    quarter = ceil(pi / 4 / acos(1 - OUTWARD / radius))
    return shape.core.buffer(radius, quad_segs=quarter)


def _grown(core: BaseGeometry, radius: float) -> Curve:
    if isinstance(core, Point):
        return circle((core.x, core.y), radius)
    assert isinstance(core, Polygon | LineString)
    corners = np.asarray(orient(core).exterior.coords)[:-1] if isinstance(core, Polygon) else np.asarray(core.coords)
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    pieces = []
    for corner, (x0, y0), (x1, y1) in zip(corners, before, after, strict=True):
        turn = abs(atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1))
        ends = [corner + radius * np.array([y, -x]) / np.hypot(x, y) for x, y in ((x0, y0), (x1, y1))]
        if turn > STRAIGHT_ON:
            pieces.append((ends[0], tan(turn / 4)))
        pieces.append((ends[1], 0.0))
    # An edge that arcs leave no length, none has: the core's corners are apart.
    return Curve(np.array([point for point, _ in pieces]), np.array([bulge for _, bulge in pieces]))


def bare(curve: Curve) -> bool:
    """Whether a curve is a circle drawn as two halves."""
    return len(curve.points) == 2 and bool((curve.bulges == 1).all())
