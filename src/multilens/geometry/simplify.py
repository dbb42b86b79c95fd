"""A shape with few straight edges that stands for one with many, or with arcs."""

from shapely import MultiPolygon, Polygon

from multilens.geometry.shape import Shape

SEGMENTS_PER_QUARTER = 8
"""Of a round corner that is cut into edges; their middles lie within 0.5 % of its radius of the arc."""


def few_edges(shape: Shape, within: bool, tolerance: float) -> Shape:
    """Give a polygon near a shape that is safe to use in its place: no larger if lenses stay within it, no smaller if clear of it.

    Arcs about a point are kept, they are smooth as they are.

    Args:
        shape: any.
        within: whether lenses stay within it (an outline) or clear of it (a keep-out).
        tolerance: by which rims of many edges may be moved, mm, > 0.

    Returns:
        The shape itself where it has few edges and no round corners that lenses stay within; else a polygon. Parts of an
        outline that are narrower than twice the tolerance are lost.
    """
    if shape.core.area == 0:
        return shape
    few = len(shape.segments) <= 4 * SEGMENTS_PER_QUARTER
    if few and (shape.radius == 0 or not within):
        return shape
    # Ends of the cut edges lie on the arc: inside for an outline. Keep-outs keep their radius.
    rim = shape.polygon(SEGMENTS_PER_QUARTER) if within else shape.core
    if not few:
        moved = rim.buffer(-tolerance if within else tolerance, quad_segs=SEGMENTS_PER_QUARTER, join_style="mitre")
        rim = moved.simplify(tolerance)
    if not isinstance(rim, Polygon | MultiPolygon) or rim.is_empty:
        return shape
    return Shape(rim, 0.0 if within else shape.radius)
