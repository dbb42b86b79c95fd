"""Distances from points to edges, in torch: exact, batched, differentiable."""

from jaxtyping import Bool, Float
from torch import Tensor


def offset_from_segments(
    point: Float[Tensor, "*batch n 2"], segments: Float[Tensor, "*#lens e 2 2"]
) -> Float[Tensor, "*batch n e 2"]:
    """Give the vector from the nearest point of every segment to every point.

    Its length is the distance to the segment, and it points where that distance grows fastest. A segment may have length 0.

    Args:
        point: mm.
        segments: start and end of each, mm; [e, 2, 2] for all points alike, or [n, e, 2, 2] for segments of each point's own.

    Returns:
        Offsets, mm.
    """
    start, along = segments[..., 0, :], segments[..., 1, :] - segments[..., 0, :]
    from_start = point.unsqueeze(-2) - start
    length_squared = along.square().sum(-1)
    share = (from_start * along).sum(-1) / length_squared.where(length_squared > 0, 1)
    return from_start - share.clamp(0, 1).unsqueeze(-1) * along


def is_crossed(point: Float[Tensor, "*batch n 2"], segments: Float[Tensor, "e 2 2"]) -> Bool[Tensor, "*batch n e"]:
    """Tell which segments every point crosses on its way out along x.

    Args:
        point: mm.
        segments: start and end of each, mm.
    """
    (x0, y0), (x1, y1) = segments[:, 0].unbind(-1), segments[:, 1].unbind(-1)
    x, y = point.unsqueeze(-2).unbind(-1)
    rise = y1 - y0
    crossing = x0 + (y - y0) / rise.where(rise != 0, 1) * (x1 - x0)
    return ((y0 > y) != (y1 > y)) & (x < crossing)


def is_inside(point: Float[Tensor, "*batch n 2"], segments: Float[Tensor, "e 2 2"]) -> Bool[Tensor, "*batch n"]:
    """Tell which points a set of closed rings encloses, by the parity of the edges crossed on the way out.

    Args:
        point: mm.
        segments: all edges of the rings, of holes too, mm.
    """
    return is_crossed(point, segments).sum(-1).remainder(2).bool()


def signed_distance(
    point: Float[Tensor, "*batch n 2"], segments: Float[Tensor, "e 2 2"], radius: float = 0.0
) -> Float[Tensor, "*batch n"]:
    """Give the distance to the rim of a shape with round corners: negative inside, positive outside.

    The distance to the core's nearest edge, with a minus sign inside the core, less the radius. Outside a core, and everywhere
    for a convex core or radius 0, it is exact. The gradient is the unit vector away from the nearest edge, or towards it from
    inside; on an edge of a ring it is the normal that points out, on a point or a line, where there is none, it is 0.

    Args:
        point: mm.
        segments: edges of the core as closed rings with the inside on their right (x to the right and y up), as `Shape` keeps
            them, mm; a point is one of length 0, a line runs there and back.
        radius: by which the core is grown, mm, >= 0.

    Returns:
        Signed distance, mm.
    """
    distance = offset_from_segments(point, segments).norm(dim=-1)
    nearest = distance.amin(-1)
    signed = nearest.where(~is_inside(point, segments), -nearest) - radius
    on_rim = distance.detach() == 0
    if on_rim.any():
        # A norm has no gradient at 0, but the signed distance passes through the rim smoothly. Lenses that are held to the
        # bounding box of a back stand exactly there and would never find the way in again.
        share = on_rim.to(signed)
        normal = share @ outward_normals(segments) / share.sum(-1, keepdim=True).clamp(min=1)
        signed = signed + ((point - point.detach()) * normal).sum(-1)
    return signed


def outward_normals(segments: Float[Tensor, "*batch e 2 2"]) -> Float[Tensor, "*batch e 2"]:
    """Give the unit vector to the left of each segment, which points out of a ring with the inside on its right.

    Args:
        segments: start and end of each, mm.

    Returns:
        Normals; 0 for a segment of length 0.
    """
    along = segments[..., 1, :] - segments[..., 0, :]
    length = along.norm(dim=-1, keepdim=True)
    return along.flip(-1) * along.new_tensor([-1.0, 1.0]) / length.where(length > 0, 1)
