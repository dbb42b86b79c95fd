"""Depth errors from the error of a texture's amplitude: stereo by its phase, defocus by how its amplitude changes with focus.

Both read the same texture with the same noise; r is the relative error of its amplitude in one image (`optics.texture`).
Lengths in millimetres. Every function is elementwise: its arguments broadcast, and dtype and device follow them.
"""

from jaxtyping import Float
from torch import Tensor


def direction_variance(
    amplitude_error_squared: Float[Tensor, "..."], radians_per_radian: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the variance of the direction in which one lens sees a texture, (r / w)^2.

    The phase of the texture is uncertain by r rad, its place by that over its frequency: var >= 2 e^2 / (n w^2 B^2).

    Args:
        amplitude_error_squared: r^2, of the amplitude after this lens' own blur, > 0.
        radians_per_radian: w, phase of the texture per angle of view (rad per mm of sensor times focal length), > 0.

    Returns:
        Variance, rad^2.

    Reference:
        docs/photometric.md, "Stereo"; Cramer-Rao bound on a shift.
    """
    return amplitude_error_squared / radians_per_radian**2


def stereo_error(
    depth: Float[Tensor, "..."], baseline: Float[Tensor, "..."], variance: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the depth error of two views, Z^2 / b sqrt(v1 + v2).

    Args:
        depth: Z, mm, > 0.
        baseline: b, mm, > 0.
        variance: v1 + v2, the variances of the two directions added, rad^2, > 0.

    Returns:
        Error of the depth, mm.

    Reference:
        Thesis, equation 4.3, the noise of the disparity being that of two directions.
    """
    return depth**2 / baseline * variance.sqrt()


def defocus_error(
    depth: Float[Tensor, "..."],
    defocus: Float[Tensor, "..."],
    sharpness: Float[Tensor, "..."],
    power_change: float,
    error_squared: Float[Tensor, "..."],
    frequency_error: float,
) -> Float[Tensor, "..."]:
    """Give the depth error of two images of different focus, Z^2 sqrt((r1^2 + r2^2) / (k dP)^2 + (2 u e_w/w)^2).

    The logarithm of the ratio of the two amplitudes is k u dP: linear in 1/Z, whatever the size of the change. It is finite in
    focus, u = 0.

    Args:
        depth: Z, mm, > 0.
        defocus: u = 1/Z - 1/Zf, 1/mm.
        sharpness: k = (w S)^2, w in rad of phase per rad of view and S the spread of the aperture, mm^2, > 0.
        power_change: dP, between the two images, 1/mm, > 0.
        error_squared: r1^2 + r2^2, of the amplitudes in the two images, > 0.
        frequency_error: e_w/w, relative error of the texture's frequency, >= 0.

    Returns:
        Error of the depth, mm.

    Reference:
        docs/photometric.md, "Defocus"; for small changes the thesis' equation 8.1 with the errors of a sensor.
    """
    inverse_depth = error_squared.sqrt() / (sharpness * power_change)
    # A known frequency is the rule, and a pass over all depths is dear.
    if frequency_error:
        inverse_depth = inverse_depth.hypot(2 * frequency_error * defocus)
    return depth**2 * inverse_depth


def equivalent_baseline(
    radians_per_radian: Float[Tensor, "..."], aperture_spread: Float[Tensor, "..."], power_change: float
) -> Float[Tensor, "..."]:
    """Give the baseline of the stereo pair that measures as well as defocus in focus, w S^2 dP.

    The pair's lenses see the texture as well as each of the two images of different focus does.

    Args:
        radians_per_radian: w, rad of phase per rad of view, > 0.
        aperture_spread: S, mm, > 0.
        power_change: dP, 1/mm, > 0.

    Returns:
        Baseline, mm.

    Reference:
        docs/photometric.md, "Defocus as stereo": `stereo_error` set equal to `defocus_error` with u = 0.
    """
    return radians_per_radian * aperture_spread**2 * power_change


def printed_defocus_error(
    depth: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
    frequency_error: float,
    amplitude_error: float,
    change_error: float,
) -> Float[Tensor, "..."]:
    """Give equation 8.1 as it is printed, Z abs(Z - Zf) / Zf sqrt(4 (e_w/w)^2 + (e_B/B)^2 + (e_Bf/Bf)^2).

    Args:
        depth: Z, mm, > 0.
        focus: in-focus depth Zf, mm, > 0.
        frequency_error: e_w/w, relative error of the texture's frequency, >= 0.
        amplitude_error: e_B/B, of its amplitude, >= 0.
        change_error: e_Bf/Bf, of the change of the amplitude with focus, >= 0.

    Returns:
        Error of the depth, mm; 0 in focus, where no camera's error of the change is a fixed part of it.

    Reference:
        Thesis, equation 8.1; E. Alexander, A theory of depth from differential defocus (2019).
    """
    relative = (4 * frequency_error**2 + amplitude_error**2 + change_error**2) ** 0.5
    return depth * (depth - focus).abs() / focus * relative
