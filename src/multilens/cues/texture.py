"""How well each lens sees a texture: the relative error of its amplitude, in focus and after blur.

The error is held as a logarithm, y = log(r^2 / t^2) with t the largest error at which the texture still counts as seen: blur adds
the square of itself to it, and nothing overflows however wide the blur.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf, log, pi
from typing import NamedTuple

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from multilens.cues.fading import CEILING, faded, fading_in_focus
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.photometry import exposed, photoelectrons, relative_noise_squared
from multilens.optics.texture import FINEST, cutoff_radius, log_diffraction_transfer, pixel_transfer
from multilens.scene import Scene


@dataclass(frozen=True)
class Sight:
    """The texture in focus, as every lens sees it.

    Args:
        frequency: w, phase of the texture per angle of view; alike at all depths where it is that on the sensor, and for all
            lenses where it is that on the object.
        log_error: y in focus.
        largest: t^2.
        smooth: whether a search asks: then every error is finite and differentiable, and more than what is claimed where the
            texture is nearly lost. Else it is what may be claimed, infinite where the texture is lost.
    """

    frequency: Float[Tensor, "#n #z"]
    log_error: Float[Tensor, "*batch n #z"]
    largest: float
    smooth: bool

    def of(self, lenses: Tensor) -> "Sight":
        """Give a line for each of some lenses, which may be named more than once."""
        frequency = self.frequency if len(self.frequency) == 1 else self.frequency[lenses]
        return Sight(frequency, self.log_error[..., lenses, :], self.largest, self.smooth)

    def error_squared(
        self, reach: Float[Tensor, "*batch n #z"], defocus: Float[Tensor, "*batch n z"]
    ) -> Float[Tensor, "*batch n z"]:
        """Give r^2 once the texture is blurred by the phase R u: its amplitude falls by exp(-(R u)^2 / 2).

        Args:
            reach: R = w S with S the spread of the aperture, mm.
            defocus: u = 1/Z - 1/Zf, 1/mm.
        """
        if self.smooth:
            return self.largest * faded(self.log_error, reach, defocus)
        log_error = self.log_error + (reach * defocus).square()
        # What overflows would make the gradient NaN even where it is not used.
        return self.largest * log_error.clamp(max=0).exp().where(log_error <= 0, inf)


def texture_sight(
    scene: Scene, light_share: float, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool
) -> Sight:
    """Give how every lens sees the texture in focus.

    Args:
        scene: the texture and its light.
        light_share: part of the light that one image gets, > 0 and <= 1.
        layout: of these lenses.
        lenses: what is known of each; all have a sensor.
        depths: Z, mm, > 0.
        smooth: whether a search asks; else it is what may be claimed.

    Reference:
        docs/photometric.md.
    """
    known = _known(scene, light_share, tuple(lenses), depths.dtype, depths.device)
    if scene.frequency_on == "object":
        known = _in_pixels(scene, known, 2 * pi * scene.cycles_per_mm * depths.unsqueeze(0))
    radius, largest = layout.aperture_radius.unsqueeze(-1), scene.least_snr**-2
    if smooth:
        # Where the pixels do not pass the texture no layout can help: the error begins at the ceiling.
        rest = known.rest + CEILING * ~known.passed
        light = (known.light, known.full_well, known.read_noise)
        return Sight(known.frequency, fading_in_focus(radius, *light, known.narrowest, rest), largest, smooth)
    share = known.narrowest / radius
    signal = (known.light * radius.square()).minimum(known.full_well)
    noise = relative_noise_squared(signal, known.read_noise)
    log_error = noise.log() - 2 * log_diffraction_transfer(share) + known.rest
    return Sight(known.frequency, log_error.where(known.passed & (share <= FINEST), inf), largest, smooth)


def refuse_unless_sensors(lenses: Sequence[Lens]) -> None:
    """Refuse lenses of which nothing is known about the sensor.

    Raises:
        ValueError: there is one.
    """
    for index, lens in enumerate(lenses):
        if lens.sensor is None:
            raise ValueError(f"sensor of lens {index + 1} must be known to a photometric cue, got none")


class _Known(NamedTuple):
    """What no layout changes, a row for each lens."""

    light: Float[Tensor, "n 1"]
    """Photoelectrons with an aperture radius of 1 mm."""
    full_well: Float[Tensor, "n 1"]
    """Photoelectrons that the mean of the texture may reach."""
    read_noise: Float[Tensor, "n 1"]
    pixel_pitch: Float[Tensor, "n 1"]
    focal_length: Float[Tensor, "n 1"]
    frequency: Float[Tensor, "#n #z"]
    """w, of the texture."""
    narrowest: Float[Tensor, "#n #z"]
    """Radius of the aperture that just no longer passes it, mm."""
    passed: Bool[Tensor, "#n #z"]
    """Where the pixels pass it."""
    rest: Float[Tensor, "#n #z"]
    """What contrast, pixels and pooling add to y."""


@lru_cache(maxsize=64)
def _known(
    scene: Scene, light_share: float, lenses: tuple[Lens, ...], dtype: torch.dtype, device: torch.device
) -> _Known:
    numbers = [
        (sensor.full_well, sensor.read_noise, sensor.efficiency * light_share, sensor.pixel_pitch, lens.focal_length)
        for lens in lenses
        if (sensor := lens.sensor) is not None
    ]
    columns = torch.tensor(numbers, dtype=dtype, device=device).T.unsqueeze(-1)
    full_well, read_noise, efficiency, pitch, focal_length = columns.unbind(0)
    exposure = (scene.light_lux, scene.reflectance, scene.exposure_ms)
    light = photoelectrons(*exposure, efficiency, pitch, torch.ones_like(pitch), focal_length)
    most = exposed(torch.full_like(full_well, inf), full_well, scene.contrast)
    frequency = 2 * pi * scene.cycles_per_mm * focal_length
    nothing = (frequency, frequency, frequency > 0, frequency)
    return _in_pixels(scene, _Known(light, most, read_noise, pitch, focal_length, *nothing), frequency)


def _in_pixels(scene: Scene, known: _Known, frequency: Float[Tensor, "#n #z"]) -> _Known:
    """Fill in what follows from the phase of the texture per angle of view."""
    cycles = frequency / (2 * pi)
    on_sensor, nyquist = cycles / known.focal_length, 1 / (2 * known.pixel_pitch)
    # Above the Nyquist frequency nothing is claimed; a zero of the transfer has no logarithm.
    contrast = scene.contrast * pixel_transfer(on_sensor.minimum(nyquist), known.pixel_pitch)
    rest = log(2 * scene.least_snr**2 / scene.pixels) - 2 * contrast.log()
    narrowest = cutoff_radius(cycles, scene.wavelength)
    return known._replace(frequency=frequency, narrowest=narrowest, passed=on_sensor <= nyquist, rest=rest)
