"""Stereo: depth from the shift of a point between two lenses, and how an error of the shift becomes one of depth.

All lengths in millimetres, disparity on the sensor too. Every function is elementwise: its arguments broadcast, and dtype
and device follow them.
"""

from jaxtyping import Float
from torch import Tensor


def disparity_to_depth(
    disparity: Float[Tensor, "..."], baseline: Float[Tensor, "..."], focal_length: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Triangulate, Z = b f / dx.

    Args:
        disparity: dx, shift of the point between the two images, mm on the sensor, > 0.
        baseline: b, distance between the centres of the two lenses, mm, > 0.
        focal_length: f, distance from lens to sensor, mm, > 0.

    Returns:
        Depth Z, mm.

    Reference:
        Thesis, equation 4.2.
    """
    return baseline * focal_length / disparity


def depth_to_disparity(
    depth: Float[Tensor, "..."], baseline: Float[Tensor, "..."], focal_length: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the shift between the two images of a point at depth Z, dx = b f / Z.

    Args:
        depth: Z, mm, > 0.
        baseline: b, mm, > 0.
        focal_length: f, mm, > 0.

    Returns:
        Disparity dx, mm on the sensor.

    Reference:
        Thesis, equation 4.2, solved for the shift.
    """
    return baseline * focal_length / depth


def stereo_sensitivity(
    depth: Float[Tensor, "..."], baseline: Float[Tensor, "..."], focal_length: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the depth error per unit of disparity error, abs(dZ / d(dx)) = Z^2 / (b f).

    Args:
        depth: Z, mm, > 0.
        baseline: b, mm, > 0.
        focal_length: f, mm, > 0.

    Returns:
        Sensitivity, mm of depth per mm of disparity. Times the noise of the disparity it is the error of the depth.

    Reference:
        Thesis, equation 4.3.
    """
    return depth**2 / (baseline * focal_length)


def pair_angular_noise(first: Float[Tensor, "..."], second: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the one angular noise that stands for two unequal lenses, sqrt((d1^2 + d2^2) / 2).

    Two equal lenses give back their own noise, so that the error of the pair is Z^2 / b times it, as in equation 4.3.

    Args:
        first: disparity noise of one lens divided by its focal length, rad, > 0.
        second: the same of the other lens, rad, > 0.

    Returns:
        Angular noise of the pair, rad.

    Reference:
        Root mean square of two independent errors.
    """
    return ((first**2 + second**2) / 2).sqrt()
