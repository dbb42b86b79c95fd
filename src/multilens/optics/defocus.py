"""Defocus: depth from the blur of a point, and how an error of the blur becomes one of depth.

All lengths in millimetres, blur on the sensor too. Every function is elementwise: its arguments broadcast, and dtype and
device follow them.
"""

from jaxtyping import Float
from torch import Tensor


def blur_to_depth(
    blur: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    sensor_distance: Float[Tensor, "..."],
    f_number: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Read depth off one defocused image, Z = f v0 / (v0 - f - c N).

    Args:
        blur: signed diameter c of the blur disc, mm on the sensor; positive beyond the in-focus depth.
        focal_length: f, mm, > 0.
        sensor_distance: v0, from lens to sensor, mm, > f.
        f_number: N = f / (2 A), > 0.

    Returns:
        Depth Z, mm.

    Reference:
        Thesis, equation 5.2; A. Pentland, A new sense for depth of field (1987).
    """
    return focal_length * sensor_distance / (sensor_distance - focal_length - blur * f_number)


def differential_blur_to_depth(
    blur_radius: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    aperture_radius: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Read depth off the blur that a change of defocus reveals, Z = Zf f A / (Zf a + f A).

    Args:
        blur_radius: signed radius a of the blur, mm on the sensor; positive nearer than the in-focus depth.
        focal_length: f, distance from lens to sensor, mm, > 0.
        aperture_radius: A, mm, > 0.
        focus: in-focus depth Zf, mm, > 0.

    Returns:
        Depth Z, mm.

    Reference:
        Thesis, equation 5.3; E. Alexander, A theory of depth from differential defocus (2019).
    """
    return focus * focal_length * aperture_radius / (focus * blur_radius + focal_length * aperture_radius)


def depth_to_differential_blur(
    depth: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    aperture_radius: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the signed blur radius of a point at depth Z, a = A f (1/Z - 1/Zf).

    Args:
        depth: Z, mm, > 0.
        focal_length: f, distance from lens to sensor, mm, > 0.
        aperture_radius: A, mm, > 0.
        focus: in-focus depth Zf, mm, > 0.

    Returns:
        Blur radius a, mm on the sensor; positive nearer than the in-focus depth.

    Reference:
        Thesis, equation 5.3, solved for the blur.
    """
    return aperture_radius * focal_length * (1 / depth - 1 / focus)


def defocus_sensitivity(
    depth: Float[Tensor, "..."], aperture_radius: Float[Tensor, "..."], focal_length: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the depth error per unit of blur-radius error, abs(dZ / da) = Z^2 / (A f).

    Args:
        depth: Z, mm, > 0.
        aperture_radius: A, mm, > 0.
        focal_length: f, mm, > 0.

    Returns:
        Sensitivity, mm of depth per mm of blur radius.

    Reference:
        Thesis, equation 5.4: stereo with the aperture for a baseline.
    """
    return depth**2 / (aperture_radius * focal_length)


def focused_sensitivity(
    depth: Float[Tensor, "..."],
    aperture_radius: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the sensitivity that knows where the lens is focused, Z abs(Z - Zf) / (2 A f).

    It is zero in focus and grows on both sides. As Zf goes to zero it becomes stereo with the aperture's diameter for a
    baseline, which is why the diameter stands here: equation 5.5 has the radius, chapter 6 the diameter.

    Args:
        depth: Z, mm, > 0.
        aperture_radius: A, mm, > 0.
        focal_length: f, mm, > 0.
        focus: in-focus depth Zf, mm, >= 0.

    Returns:
        Sensitivity, mm of depth per mm of blur.

    Reference:
        Thesis, equation 5.5 in the form of its chapter 6; Y. Schechner and N. Kiryati, Depth from defocus vs. stereo: how
        different really are they? (2000), for the equality with stereo.
    """
    return depth * (depth - focus).abs() / (2 * aperture_radius * focal_length)


def defocus_band(
    focus: Float[Tensor, "..."], aperture_radius: Float[Tensor, "..."], baseline: Float[Tensor, "..."]
) -> tuple[Float[Tensor, "..."], Float[Tensor, "..."]]:
    """Give the depths between which defocus beats stereo, Zf / (1 + 2A/b) and Zf / (1 - 2A/b).

    For equal focal lengths and equal noise of blur and disparity.

    Args:
        focus: in-focus depth Zf, mm, > 0.
        aperture_radius: A, mm, > 0.
        baseline: b of the best stereo pair, mm, > 2 A.

    Returns:
        Nearest and farthest depth of the band, mm.

    Reference:
        Where Z^2 / (b f) = Z abs(Z - Zf) / (2 A f).
    """
    ratio = 2 * aperture_radius / baseline
    return focus / (1 + ratio), focus / (1 - ratio)
