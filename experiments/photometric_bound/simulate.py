"""Noisy images of a sinusoid, and depth read from them; nothing here knows of the bounds they are held against."""

from dataclasses import dataclass
from math import exp, pi

import torch
from torch import Tensor

PERIODS = 7
"""Of the texture among the pixels that are read together."""


@dataclass(frozen=True)
class Camera:
    """A lens with a Gaussian aperture, and what it looks at.

    Args:
        spread: standard deviation of the aperture, mm.
        focal_length: from lens to sensor, mm.
        focus: in-focus depth, mm.
        frequency: of the texture, rad per mm of sensor.
        contrast: of the texture.
        noise: standard deviation of a pixel over the mean signal.
        pixels: read together.
        power_change: between the two images, 1/mm.
    """

    spread: float = 1.0
    focal_length: float = 12.0
    focus: float = 800.0
    frequency: float = 150.0
    contrast: float = 0.3
    noise: float = 0.01
    pixels: int = 200
    power_change: float = 6e-5

    def amplitude(self, depth: float, power: float = 0.0) -> float:
        """Give the amplitude of the texture in an image taken with a little more optical power."""
        blur = self.spread * self.focal_length * (1 / depth - 1 / self.focus - power)
        return self.contrast * exp(-((self.frequency * blur) ** 2) / 2)


def seen(camera: Camera, amplitude: float, draws: int, random: torch.Generator) -> Tensor:
    """Fit amplitude and phase to many noisy images of a sinusoid of phase 0; give them as complex numbers."""
    phase = torch.arange(camera.pixels, dtype=torch.float64) * (2 * pi * PERIODS / camera.pixels)
    waves = torch.stack([phase.cos(), phase.sin()], -1) * (2 / camera.pixels)
    noise = torch.randn(draws, camera.pixels, dtype=torch.float64, generator=random) * camera.noise
    return torch.view_as_complex((amplitude * phase.cos() + noise) @ waves)


def defocus_error(camera: Camera, depth: float, draws: int, random: torch.Generator) -> float:
    """Give the error of depths read by differential defocus: Q = Bf / (w^2 B), and 1/Z is linear in Q."""
    more, less = (
        seen(camera, camera.amplitude(depth, power), draws, random).abs()
        for power in (camera.power_change / 2, -camera.power_change / 2)
    )
    q = 2 * (more - less) / (camera.frequency**2 * (more + less))
    inverse_depth = 1 / camera.focus + q / (camera.power_change * camera.spread**2 * camera.focal_length**2)
    return inverse_depth.std().item() * depth**2


def stereo_error(camera: Camera, depth: float, baseline: float, draws: int, random: torch.Generator) -> float:
    """Give the error of depths read from the shift between the images of two such cameras."""
    left, right = (seen(camera, camera.amplitude(depth), draws, random).angle() / camera.frequency for _ in range(2))
    return (left - right).std().item() * depth**2 / (baseline * camera.focal_length)
