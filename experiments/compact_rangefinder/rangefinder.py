"""A rangefinder of two lenses 4 mm apart, focused at two depths, and what it measures by stereo, by defocus and by both."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi, sqrt

import torch
from jaxtyping import Float
from torch import Tensor

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.cues import Cue, Measurement
from multilens.optics.photometry import exposed, photoelectrons, relative_noise_squared
from multilens.working_range import working_range

NEAR, FAR = 300.0, 1640.0
"""mm; the published range."""

TOLERANCE = ml.Tolerance(mm=10 / sqrt(2 / pi))
"""Standard deviation of Gaussian errors whose mean absolute value is 1 cm."""

SPAN = (100.0, 10_000.0)
"""mm; where a working range is looked for."""

ASKED = ml.log_depths(NEAR, FAR, 200)

PRESET = build_problem(read_given(["experiment=devices/d3s"]).config)
LENS = PRESET.lenses[0]

PITCH = 0.002
"""mm; of the preset's pixels."""

ALL_SIZES = (4, 8, 16, 32, 64)
"""Periods of a texture with detail of every size, pixels, an octave apart; as in the study of published ranges."""

OFFICE = (10,)
"""The one period of the scene `office`, 50 cycles per mm, pixels."""

MIDDLE = 2 / (1 / NEAR + 1 / FAR)
"""mm; half way through the range in dioptres, 507 mm."""

DIFFERENTIAL = 0.2
"""Dioptres; a small difference of the two foci, the middle of those that the study of published ranges sweeps."""

HALVES = 500 * (1 / NEAR - 1 / FAR)
"""Dioptres; the difference of two foci that stand in the middle of the near and of the far half, 377 and 775 mm."""


@dataclass(frozen=True)
class PairDefocus:
    """Defocus between the images of lenses 1 and 2, which are focused at two depths.

    Their amplitudes are those of two images of one lens that is focused half way between them, in dioptres.

    Args:
        scene: the texture and its light.
    """

    scene: ml.Scene

    def measurements(self, lenses: Sequence[ml.Lens]) -> tuple[Measurement, ...]:
        """Name the one measurement."""
        return (Measurement("defocus", (0, 1), None, "defocus 1-2"),)

    def __call__(
        self, layout: ml.Layout, lenses: Sequence[ml.Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "1 z"]:
        """Give its depth error, mm, infinite where either image has lost the texture."""
        first, second = (1 / layout.focus[..., 0]).tolist()
        between = ml.Layout(layout.position[:1], layout.aperture_radius[:1], [2 / (first + second)])
        return ml.PhotometricDefocus(self.scene, 1000 * abs(first - second))(between, lenses[:1], depths)


@dataclass(frozen=True)
class Rangefinder:
    """Two equal lenses and a texture; as it is, the preset `d3s` in the light and contrast of the scene `office`.

    Bands of a texture are independent measurements, as are the amplitude and the phase of each: all are put together.

    Args:
        aperture_radius: mm.
        baseline: mm.
        power_change: between the two foci, dioptres, > 0.
        contrast: of the texture, in each of its bands.
        periods: of the texture, pixels, each with the same contrast.
        pixels: read together, or a square of one period if that is more.
        light_lux: at 1/30 s.
    """

    aperture_radius: float = LENS.aperture_radius[1]
    baseline: float = 4.0
    power_change: float = DIFFERENTIAL
    contrast: float = 0.2
    periods: tuple[int, ...] = ALL_SIZES
    pixels: int = 1089
    light_lux: float = 500.0

    @property
    def scenes(self) -> list[ml.Scene]:
        """One for each band of the texture."""
        frequencies = [1 / (period * PITCH) for period in self.periods]
        pixels = [max(self.pixels, period**2) for period in self.periods]
        light, exposure_ms = self.light_lux, 33.3
        return [
            ml.Scene(self.contrast, frequency, light, exposure_ms, count)
            for frequency, count in zip(frequencies, pixels, strict=True)
        ]

    @property
    def lenses(self) -> list[ml.Lens]:
        """Both, with the preset's focal length and sensor."""
        return [ml.Lens(LENS.focal_length, (self.aperture_radius, self.aperture_radius), sensor=LENS.sensor)] * 2

    @property
    def foci(self) -> list[float]:
        """mm; of lens 1, the nearer, and lens 2."""
        return [1 / (1 / MIDDLE + sign * self.power_change / 2000) for sign in (1, -1)]

    @property
    def layout(self) -> ml.Layout:
        """Where they stand and focus."""
        return ml.Layout([[0.0, 0.0], [self.baseline, 0.0]], [self.aperture_radius] * 2, self.foci)

    def problem(self, way: str) -> ml.Problem:
        """Give the question by one way to measure, of WAYS."""
        stereo: list[Cue] = [ml.PhotometricStereo(scene) for scene in self.scenes]
        defocus: list[Cue] = [PairDefocus(scene) for scene in self.scenes]
        cues = {"stereo": stereo, "defocus": defocus, "both": [*stereo, *defocus]}
        back = ml.Back.rectangle(16, 12)
        return ml.Problem(back, self.lenses, ASKED, cues=cues[way], fusion=ml.InverseVariance())

    def errors(self, way: str, depths: Float[Tensor, " z"] = ASKED) -> Float[Tensor, " z"]:
        """Give the standard deviation of the depth, mm, infinite where nothing is measured."""
        problem = self.problem(way)
        return problem.fusion.squared_error(problem.cues, self.layout, problem.lenses, depths).sqrt()

    def covers(self, way: str) -> bool:
        """Say whether the error is within tolerance over all of the published range."""
        return bool((self.errors(way) <= (TOLERANCE.mm or 0.0)).all())

    def working_range(self, way: str) -> ml.WorkingRange:
        """Give the depths within tolerance."""
        return working_range(self.problem(way), self.layout, TOLERANCE, SPAN)


WAYS = ("stereo", "defocus", "both")


def changed(device: Rangefinder, name: str, value: float) -> Rangefinder:
    """Give a rangefinder of which one number is another; pixels are whole."""
    return replace(device, **{name: max(1, round(value)) if name == "pixels" else value})


def noise(device: Rangefinder) -> float:
    """Give the noise of a pixel over its signal."""
    sensor, scene = LENS.sensor, device.scenes[0]
    assert sensor is not None
    light = (scene.light_lux, scene.reflectance, scene.exposure_ms)
    numbers = (sensor.efficiency, sensor.pixel_pitch, device.aperture_radius, LENS.focal_length)
    signal = photoelectrons(*light, *(torch.tensor(number, dtype=torch.float64) for number in numbers))
    signal = exposed(signal, torch.tensor(sensor.full_well, dtype=torch.float64), scene.contrast)
    return relative_noise_squared(signal, torch.tensor(sensor.read_noise, dtype=torch.float64)).sqrt().item()
