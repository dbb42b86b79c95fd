"""The thin lens: f-number, where the image forms, how wide a point out of focus spreads.

All lengths in millimetres. Distances are measured from the lens and positive on their own side of it. Every function is
elementwise: its arguments broadcast against each other, and dtype and device follow them.
"""

from jaxtyping import Float
from torch import Tensor


def f_number(focal_length: Float[Tensor, "..."], aperture_radius: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the f-number of a lens, N = f / (2 A).

    Args:
        focal_length: f, mm, > 0.
        aperture_radius: radius A of the entrance pupil, mm, > 0.

    Returns:
        N, without unit.

    Reference:
        Thesis, equation 5.1, with D = 2 A.
    """
    return focal_length / (2 * aperture_radius)


def image_distance(focal_length: Float[Tensor, "..."], depth: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the distance behind the lens at which a point comes to focus, v = f Z / (Z - f).

    Args:
        focal_length: f, mm, > 0.
        depth: Z, mm, > f (nearer points have no real image).

    Returns:
        v, mm, >= f.

    Reference:
        The Gaussian lens formula 1/f = 1/Z + 1/v.
    """
    return focal_length * depth / (depth - focal_length)


def circle_of_confusion(
    focal_length: Float[Tensor, "..."],
    aperture_radius: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
    depth: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the diameter of the disc into which a point spreads on the sensor, c = 2 A v0 (1/Zf - 1/Z).

    The sensor stands at v0, where depth Zf is sharp. The sign tells the side: positive beyond the in-focus depth, negative
    before it.

    Args:
        focal_length: f, mm, > 0.
        aperture_radius: A, mm, > 0.
        focus: in-focus depth Zf, mm, > f.
        depth: Z, mm, > 0.

    Returns:
        Signed diameter c on the sensor, mm.

    Reference:
        Similar triangles behind a thin lens: c = 2 A (v0 - v) / v with v the image distance of Z.
    """
    return 2 * aperture_radius * image_distance(focal_length, focus) * (1 / focus - 1 / depth)
