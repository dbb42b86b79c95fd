"""When two lenses may measure depth together: how large their parallax may be, and how near the point.

The parallax of a point at depth Z seen by two lenses a baseline b apart is the tangent b / Z, the same all over the field. Every
limit here is a largest parallax or a nearest depth, so that a pair fails near by and works beyond: `nearest_depth`. Lenses look
the same way; lengths in millimetres. Every function is elementwise: its arguments broadcast, and dtype and device follow them.
"""

import torch
from jaxtyping import Float
from torch import Tensor


def disparity_parallax(
    first_focal_length: Float[Tensor, "..."], second_focal_length: Float[Tensor, "..."], max_disparity: float
) -> Float[Tensor, "..."]:
    """Give the largest parallax whose shift a matcher still finds, d_max / max(f1, f2).

    The shift of a point is b f / Z on the sensor behind f. Of two unequal lenses the longer shifts it most, so that the limit
    is kept on both sensors exactly where it is kept on the longer lens'.

    Args:
        first_focal_length: f1, mm, > 0.
        second_focal_length: f2, mm, > 0.
        max_disparity: d_max, mm on the sensor, > 0.

    Returns:
        Largest b / Z, a tangent.

    Reference:
        docs/pairs.md, "How far a matcher looks".
    """
    return max_disparity / torch.maximum(first_focal_length, second_focal_length)


def field_overlap(
    depth: Float[Tensor, "..."],
    baseline: Float[Tensor, "..."],
    first_tangent: Float[Tensor, "..."],
    second_tangent: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the part of the narrower field that both lenses see, (Z (t1 + t2) - b) / (2 Z t), from 0 to 1.

    Measured along the baseline, where the fields reach from x1 - Z t1 to x1 + Z t1 and from x2 - Z t2 to x2 + Z t2. For equal
    fields it is 1 - b / (2 Z t). A narrow field lies wholly within a wide one up to the baseline Z abs(t1 - t2).

    Args:
        depth: Z, mm, > 0.
        baseline: b, mm, >= 0.
        first_tangent: t1, of half the field of view of one lens, > 0.
        second_tangent: t2, of the other; t is the smaller of the two.

    Returns:
        Share of the narrower field.

    Reference:
        docs/pairs.md, "What both lenses see".
    """
    narrower = torch.minimum(first_tangent, second_tangent)
    return ((first_tangent + second_tangent - baseline / depth) / (2 * narrower)).clamp(0, 1)


def overlap_parallax(
    first_tangent: Float[Tensor, "..."], second_tangent: Float[Tensor, "..."], least_overlap: float
) -> Float[Tensor, "..."]:
    """Give the largest parallax at which the fields overlap enough, t1 + t2 - 2 t s.

    Args:
        first_tangent: t1, of half the field of view of one lens, > 0.
        second_tangent: t2, of the other; t is the smaller of the two.
        least_overlap: s, part of the narrower field that both must see, >= 0 and < 1.

    Returns:
        Largest b / Z, a tangent, > 0.

    Reference:
        `field_overlap` set to s and solved for b / Z.
    """
    return first_tangent + second_tangent - 2 * least_overlap * torch.minimum(first_tangent, second_tangent)


def nearest_depth(
    baseline: Float[Tensor, "..."], largest_parallax: Float[Tensor, "..."], near_focus: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the depth from which on a pair may be used, max(b / P, N).

    Args:
        baseline: b, mm, >= 0.
        largest_parallax: P, the least of what limits b / Z, > 0, infinite where nothing does.
        near_focus: N, the farther of the two lenses' near focus, mm, >= 0.

    Returns:
        Nearest usable depth, mm.

    Reference:
        docs/pairs.md, "From which depth on".
    """
    return torch.maximum(baseline / largest_parallax, near_focus)
