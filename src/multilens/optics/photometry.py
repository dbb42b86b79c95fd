"""Photometry: how many photoelectrons a pixel collects through a lens, and how noisy they are.

Lengths in millimetres. Every function is elementwise: its arguments broadcast, and dtype and device follow them.
"""

import torch
from jaxtyping import Float
from torch import Tensor

PLANCK = 6.62607015e-34
"""J s, exact by the definition of the kilogram."""

LUMENS_PER_WATT = 683
"""Of light of 540 THz (555 nm), exact by the definition of the candela."""

PHOTONS = 1e-6 / (LUMENS_PER_WATT * PLANCK * 540e12)
"""In a lux second on a square mm, of light of 555 nm: 4.09e9. White light has more for the same lux, as the eye sees its ends
badly; the difference is left aside."""


def photoelectrons(
    light_lux: float,
    reflectance: float,
    exposure_ms: float,
    efficiency: Float[Tensor, "..."],
    pixel_pitch: Float[Tensor, "..."],
    aperture_radius: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give what a pixel collects of an evenly lit surface, E = q K p^2 t R L (A / f)^2.

    A surface that scatters the part R of the illuminance L evenly sends R L / pi lumens per square metre and steradian. The
    aperture fills the solid angle pi (A / f)^2 of the sensor, so that the image has the illuminance R L (A / f)^2: it grows with
    the area of the aperture, and does not depend on the depth of the surface.

    Args:
        light_lux: L, illuminance of the object, lux, > 0.
        reflectance: R, > 0 and <= 1.
        exposure_ms: t, ms, > 0.
        efficiency: q, photoelectrons per photon, > 0 and <= 1.
        pixel_pitch: p, mm, > 0.
        aperture_radius: A, mm, > 0, small against f.
        focal_length: f, mm, > 0.

    Returns:
        Photoelectrons.

    Reference:
        docs/photometric.md, "Light".
    """
    at_unit_aperture = PHOTONS * exposure_ms / 1000 * reflectance * light_lux
    return at_unit_aperture * efficiency * (pixel_pitch * aperture_radius / focal_length) ** 2


def exposed(
    photoelectrons: Float[Tensor, "..."], full_well: Float[Tensor, "..."], contrast: float
) -> Float[Tensor, "..."]:
    """Give the mean signal once the exposure is shortened so that no pixel overflows, min(E, W / (1 + c)).

    Args:
        photoelectrons: E of the longest exposure, > 0.
        full_well: W, electrons, > 0.
        contrast: c of the texture, whose bright places hold 1 + c times the mean.

    Returns:
        Mean photoelectrons of a pixel.

    Reference:
        docs/photometric.md, "Light".
    """
    return torch.minimum(photoelectrons, full_well / (1 + contrast))


def relative_noise_squared(signal: Float[Tensor, "..."], read_noise: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the variance of a pixel over its signal squared, (E + s^2) / E^2: shot noise and read noise.

    Args:
        signal: E, mean photoelectrons, > 0.
        read_noise: s, electrons, >= 0.

    Returns:
        e^2, the square of a part of the signal.

    Reference:
        docs/photometric.md, "Noise"; the variance of a Poisson number is its mean.
    """
    return (signal + read_noise**2) / signal**2
