"""From the curves of a drawing to a shape: exact where it can be, else on the safe side by a tolerance."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from shapely import MultiPoint, MultiPolygon, Polygon

from multilens.cad.curve import Curve, refuse_too_many
from multilens.geometry.shape import Shape

SAME = 1e-6
"""mm; radii and places that differ by less are one: programs round what they write."""

DECIMALS = 9
"""Of a millimetre, to which centres and radii are rounded: what arcs lose when they are written as their ends."""


def shape_of(curves: Sequence[Curve], within: bool, tolerance: float) -> tuple[Shape, float]:
    """Give the shape that curves enclose: what lies in an odd number of them.

    A circle, and a convex curve whose every corner is round by one radius, become exactly that. Straight edges stay as they are.
    All else is cut into edges within half the tolerance, and the rim then moved by the other half to the safe side.

    Args:
        curves: mm, at least one.
        within: whether lenses stay within the shape (an outline, which may only shrink) or clear of it.
        tolerance: by which the rim may move, mm, > 0.

    Returns:
        The shape, and by how much its rim may have moved, mm.

    Raises:
        ValueError: curves cross themselves or each other, enclose nothing, or become too many edges.
    """
    grown = grown_core(curves[0]) if len(curves) == 1 else None
    if grown is not None:
        return grown, 0.0
    corners = [curve.cut(tolerance / 2) for curve in curves]
    refuse_too_many(sum(map(len, corners)))
    whole = _nested([_polygon(ring) for ring in corners])
    if all(curve.straight for curve in curves):
        return Shape(whole), 0.0
    moved = Shape(whole).core.buffer(-tolerance / 2 if within else tolerance / 2, join_style="mitre", mitre_limit=2)
    if not isinstance(moved, Polygon | MultiPolygon) or moved.is_empty:
        raise ValueError(f"shape must be wider than the tolerance of {tolerance:g} mm, got less")
    return Shape(moved), tolerance


def grown_core(curve: Curve) -> Shape | None:
    """Give a convex core grown by a radius whose rim a curve is; None where it is not one."""
    if not curve.exact or not curve.bulges.any() or (curve.bulges < 0).any() == (curve.bulges > 0).any():
        return None
    radii = curve.radii
    if np.ptp(radii) > SAME:
        return None
    core = MultiPoint(_apart(np.round(curve.centres, DECIMALS))).convex_hull
    shape = Shape(core, round(float(radii.mean()), DECIMALS))
    on_rim = np.concatenate([curve.points, curve.middles])
    off = np.abs(shape.signed_distance(*on_rim.T))
    # Every end and middle on the rim of a convex shape, and once around it: the curve is the rim.
    once = abs(Polygon(curve.cut(0.01 * shape.radius)).area / shape.area - 1) < 0.1
    return shape if once and off.max() <= SAME and core.equals(core.convex_hull) else None


def _apart(points: Float[np.ndarray, "a 2"]) -> list[tuple[float, float]]:
    """Give points without those that are one with another: a corner may be drawn as several arcs."""
    found: list[tuple[float, float]] = []
    for x, y in points.tolist():
        if all(max(abs(x - a), abs(y - b)) > SAME for a, b in found):
            found.append((x, y))
    return found


def _polygon(ring: np.ndarray) -> Polygon:
    if len(ring) < 3:
        raise ValueError(f"curve must have at least 3 corners, got {len(ring)}")
    polygon = Polygon(ring)
    Shape(polygon)
    return polygon


def _nested(polygons: Sequence[Polygon]) -> Polygon | MultiPolygon:
    """Give what lies in an odd number of polygons that do not cross; one that is drawn twice counts once."""
    apart: list[Polygon] = []
    for polygon in polygons:
        if not any(polygon.equals(other) for other in apart):
            apart.append(polygon)
    around = [
        [j for j, other in enumerate(apart) if j != i and other.contains(polygon)] for i, polygon in enumerate(apart)
    ]
    parts = []
    for i, shell in enumerate(apart):
        if len(around[i]) % 2 == 0:
            holes = [hole for j, hole in enumerate(apart) if i in around[j] and len(around[j]) == len(around[i]) + 1]
            parts.append(Polygon(shell.exterior, [hole.exterior for hole in holes]))
    return parts[0] if len(parts) == 1 else MultiPolygon(parts)
