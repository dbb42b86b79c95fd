"""How well each lens sees a texture: the relative error of its amplitude, in focus and after blur.

The error is held as a logarithm, y = log(r^2 / t^2) with t the largest error at which the texture still counts as seen: blur adds
the square of itself to it, and nothing overflows however wide the blur.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import log, pi
from typing import NamedTuple

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from multilens.layout import Layout
from multilens.lens import Lens
from multilens.numerics import tangent_exp
from multilens.optics.photometry import exposed, photoelectrons, relative_noise_squared
from multilens.optics.texture import FINEST, cutoff_share, log_diffraction_transfer, pixel_transfer
from multilens.scene import Scene

CEILING = 16.0
"""Of y, in the smooth errors alone: there the error is 3000 times one at which the texture is lost, which is as good as none;
beyond it r^2 grows in a straight line with y, a slope that a search can follow back."""


@dataclass(frozen=True)
class Sight:
    """The texture in focus, as every lens sees it.

    Args:
        frequency: w, phase of the texture per angle of view; alike at all depths where it is that on the sensor, and for all
            lenses where it is that on the object.
        log_error: y in focus; its gradient is the aperture's.
        resolved: where neither pixels nor diffraction have wiped out the texture.
        largest: t^2.
    """

    frequency: Float[Tensor, "#n #z"]
    log_error: Float[Tensor, "*batch n #z"]
    resolved: Bool[Tensor, "*batch n #z"]
    largest: float

    def of(self, lenses: Tensor) -> "Sight":
        """Give a line for each of some lenses, which may be named more than once."""
        frequency = self.frequency if len(self.frequency) == 1 else self.frequency[lenses]
        return Sight(frequency, self.log_error[..., lenses, :], self.resolved[..., lenses, :], self.largest)

    def blurred(self, blur: Float[Tensor, "*batch n z"]) -> Float[Tensor, "*batch n z"]:
        """Give y after a blur of the phase w s rad, s its standard deviation: the amplitude falls by exp(-(w s)^2 / 2)."""
        return self.log_error + blur.square()

    def error_squared(self, log_error: Float[Tensor, "*batch n z"]) -> Float[Tensor, "*batch n z"]:
        """Give r^2 of y: finite, and differentiable, for any y."""
        return self.largest * tangent_exp(log_error, CEILING)

    def seen(self, log_error: Float[Tensor, "*batch n z"]) -> Bool[Tensor, "*batch n z"]:
        """Say where the texture stands out of the noise, and has detail that pixels and diffraction pass."""
        return (log_error <= 0) & self.resolved


def texture_sight(
    scene: Scene, light_share: float, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
) -> Sight:
    """Give how every lens sees the texture in focus.

    Args:
        scene: the texture and its light.
        light_share: part of the light that one image gets, > 0 and <= 1.
        layout: of these lenses.
        lenses: what is known of each; all have a sensor.
        depths: Z, mm, > 0.

    Reference:
        docs/photometric.md.
    """
    known = _known(scene, light_share, tuple(lenses), depths.dtype, depths.device)
    radius = layout.aperture_radius
    signal = exposed(known.light * radius**2, known.full_well, scene.contrast)
    noise = relative_noise_squared(signal, known.read_noise).log().unsqueeze(-1)
    frequency, log_contrast, passed = _in_pixels(scene, known, depths)
    share = cutoff_share(frequency / (2 * pi), radius.unsqueeze(-1), scene.wavelength)
    log_error = (
        noise - 2 * (log_contrast + log_diffraction_transfer(share)) + log(2 * scene.least_snr**2 / scene.pixels)
    )
    return Sight(frequency, log_error, passed & (share <= FINEST), scene.least_snr**-2)


def refuse_unless_sensors(lenses: Sequence[Lens]) -> None:
    """Refuse lenses of which nothing is known about the sensor.

    Raises:
        ValueError: there is one.
    """
    for index, lens in enumerate(lenses):
        if lens.sensor is None:
            raise ValueError(f"sensor of lens {index + 1} must be known to a photometric cue, got none")


class _Known(NamedTuple):
    """What no layout changes, a number for each lens."""

    light: Float[Tensor, " n"]
    """Photoelectrons with an aperture radius of 1 mm."""
    full_well: Float[Tensor, " n"]
    read_noise: Float[Tensor, " n"]
    pixel_pitch: Float[Tensor, "n 1"]
    focal_length: Float[Tensor, "n 1"]


@lru_cache(maxsize=64)
def _known(
    scene: Scene, light_share: float, lenses: tuple[Lens, ...], dtype: torch.dtype, device: torch.device
) -> _Known:
    sensors = [lens.sensor for lens in lenses if lens.sensor is not None]
    rows = [[s.full_well, s.read_noise, s.efficiency, s.pixel_pitch] for s in sensors]
    full_well, read_noise, efficiency, pitch = torch.tensor(rows, dtype=dtype, device=device).T
    focal_length = torch.tensor([lens.focal_length for lens in lenses], dtype=dtype, device=device)
    light = photoelectrons(
        scene.light_lux,
        scene.reflectance,
        scene.exposure_ms,
        efficiency * light_share,
        pitch,
        torch.ones_like(pitch),
        focal_length,
    )
    return _Known(light, full_well, read_noise, pitch.unsqueeze(-1), focal_length.unsqueeze(-1))


def _in_pixels(
    scene: Scene, known: _Known, depths: Float[Tensor, " z"]
) -> tuple[Float[Tensor, "#n #z"], Float[Tensor, "#n #z"], Bool[Tensor, "#n #z"]]:
    """Give w, the logarithm of the contrast behind the pixels, and where they pass the texture."""
    if scene.frequency_on == "object":
        frequency = 2 * pi * scene.cycles_per_mm * depths.unsqueeze(0)
    else:
        frequency = 2 * pi * scene.cycles_per_mm * known.focal_length
    cycles = frequency / (2 * pi * known.focal_length)
    nyquist = 1 / (2 * known.pixel_pitch)
    transfer = pixel_transfer(cycles.minimum(nyquist), known.pixel_pitch)
    passed = cycles <= nyquist
    # Where the pixels do not pass it no layout can help: the smooth error begins at the ceiling.
    return frequency, (scene.contrast * transfer).log() - CEILING / 2 * ~passed, passed
