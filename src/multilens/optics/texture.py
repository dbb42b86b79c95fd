"""Texture: how much of its contrast comes through pixels, diffraction and defocus, and how well what is left is measured.

A transfer is the amplitude of a sinusoid in the image over that in the scene. Lengths in millimetres. Every function is
elementwise: its arguments broadcast, and dtype and device follow them.
"""

from math import acos, pi, sqrt

import torch
from jaxtyping import Float
from torch import Tensor

FINEST = 0.95
"""Part of the cutoff of diffraction up to which a texture counts as seen; its transfer is 0.013 there."""

_LEFT = acos(FINEST) - FINEST * sqrt(1 - FINEST**2)
FALL = 2 * sqrt(1 - FINEST**2) / _LEFT
"""Slope of the logarithm of the transfer from FINEST on, downward."""


def pixel_transfer(frequency: Float[Tensor, "..."], pixel_pitch: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the transfer of square pixels that leave no gap, sin(pi v p) / (pi v p).

    Args:
        frequency: v, cycles per mm of sensor, >= 0.
        pixel_pitch: p, mm, > 0.

    Returns:
        Transfer; from 1 down to 2 / pi at the Nyquist frequency 1 / (2 p).

    Reference:
        Mean of a sinusoid over the width of a pixel.
    """
    return torch.sinc(frequency * pixel_pitch)


def cutoff_radius(cycles_per_radian: Float[Tensor, "..."], wavelength: float) -> Float[Tensor, "..."]:
    """Give the radius of the round aperture that just no longer passes a frequency, v l / 2.

    Args:
        cycles_per_radian: v, cycles per mm of sensor times mm from lens to sensor, >= 0.
        wavelength: l, mm, > 0.

    Returns:
        Radius, mm. Over the radius of an aperture it is the share x of its cutoff at which the frequency lies.

    Reference:
        J. W. Goodman, Introduction to Fourier Optics, section 6.3: the cutoff is 2 A / l cycles per radian.
    """
    return cycles_per_radian * wavelength / 2


def log_diffraction_transfer(share: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the logarithm of the transfer of a round aperture in focus, 2/pi (arccos x - x sqrt(1 - x^2)).

    Beyond x = 0.95 it goes on along its tangent, so that it stays finite and has a slope: nothing is claimed there.

    Args:
        share: x, frequency over the cutoff, >= 0.

    Returns:
        Logarithm of the transfer, 0 at x = 0.

    Reference:
        J. W. Goodman, Introduction to Fourier Optics, section 6.3.
    """
    seen = share.clamp(max=FINEST)
    transfer = 2 / pi * (seen.acos() - seen * (1 - seen**2).sqrt())
    return transfer.log() - FALL * (share - seen)


def blur_spread(
    aperture_spread: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    focus: Float[Tensor, "..."],
    depth: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the signed standard deviation of the blur on the sensor, S f (1/Z - 1/Zf).

    Args:
        aperture_spread: S, standard deviation of the light over the aperture along one axis, mm, > 0; of an even disc half its
            radius.
        focal_length: f, distance from lens to sensor, mm, > 0.
        focus: in-focus depth Zf, mm, > 0.
        depth: Z, mm, > 0.

    Returns:
        Standard deviation, mm on the sensor; positive nearer than the in-focus depth.

    Reference:
        A ray through the aperture at a meets the sensor a f (1/Z - 1/Zf) from where the sharp point would be.
    """
    return aperture_spread * focal_length * (1 / depth - 1 / focus)


def defocus_transfer(angular_frequency: Float[Tensor, "..."], spread: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the transfer of a Gaussian blur, exp(-(w s)^2 / 2).

    Args:
        angular_frequency: w, rad per mm of sensor, >= 0.
        spread: s, standard deviation of the blur, mm on the sensor.

    Returns:
        Transfer.

    Reference:
        Fourier transform of a Gaussian.
    """
    return (-((angular_frequency * spread) ** 2) / 2).exp()


def amplitude_error(
    relative_noise: Float[Tensor, "..."], pixels: int, amplitude: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give the least relative error of a sinusoid's amplitude, r = e sqrt(2 / n) / B, which is that of its phase in rad too.

    Args:
        relative_noise: e, standard deviation of a pixel over the mean signal, > 0.
        pixels: n read together, over whole periods, >= 1.
        amplitude: B of the sinusoid over the mean signal, > 0.

    Returns:
        r, a part of the amplitude, and rad of the phase.

    Reference:
        Cramer-Rao bound for a sinusoid in white noise; D. Rife and R. Boorstyn, Single-tone parameter estimation from
        discrete-time observations (1974).
    """
    return relative_noise * (2 / pixels) ** 0.5 / amplitude
