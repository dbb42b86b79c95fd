"""The phone's camera of the study, the questions asked of it, and the bounds of the simulated camera."""

from dataclasses import replace

import torch
from simulate import Camera
from torch import Tensor

import multilens as ml
from multilens.optics import photometric
from multilens.optics.texture import amplitude_error, blur_spread, defocus_transfer

DEPTHS = (400.0, 500.0, 600.0, 700.0, 800.0, 1000.0, 1500.0, 2000.0)
BASELINE = 20.0
"""mm; about that of a phone's camera island."""

FOCUS = 1000.0
"""mm; of the phone's camera."""

OFFICE = ml.Scene(contrast=0.2, cycles_per_mm=50, light_lux=500, exposure_ms=33.3, pixels=1089)
LIGHTS = {"daylight": 10_000.0, "office": 500.0, "dim room": 20.0}
"""lux, as in conf/scene."""

F_NUMBERS = (1.78, 2.8, 4.0, 8.0)
SENSOR = ml.Sensor(pixel_pitch_um=1.22, full_well=5060, read_noise=3, efficiency=0.5)
"""As in conf/lenses/iphone_main.yaml, which tells what is an estimate."""

LENS = ml.Lens.from_f_number(6.86, (1.78, 11), sensor=SENSOR)
POWER_CHANGE = 1.0
"""Dioptres, between the two images of the phone's camera."""


def amplitude_error_squared(camera: Camera, depth: Tensor, power: float) -> Tensor:
    focus = torch.tensor(1 / (1 / camera.focus + power), dtype=depth.dtype)
    spread, focal_length, frequency = (
        torch.tensor(x, dtype=depth.dtype) for x in (camera.spread, camera.focal_length, camera.frequency)
    )
    left = camera.contrast * defocus_transfer(frequency, blur_spread(spread, focal_length, focus, depth))
    return amplitude_error(torch.tensor(camera.noise, dtype=depth.dtype), camera.pixels, left) ** 2


def defocus_bound(camera: Camera, depth: Tensor) -> Tensor:
    half = camera.power_change / 2
    errors = amplitude_error_squared(camera, depth, half) + amplitude_error_squared(camera, depth, -half)
    sharpness = torch.tensor((camera.frequency * camera.focal_length * camera.spread) ** 2, dtype=depth.dtype)
    return photometric.defocus_error(depth, 1 / depth - 1 / camera.focus, sharpness, camera.power_change, errors, 0.0)


def stereo_bound(camera: Camera, depth: Tensor) -> Tensor:
    w = torch.tensor(camera.frequency * camera.focal_length, dtype=depth.dtype)
    variance = 2 * photometric.direction_variance(amplitude_error_squared(camera, depth, 0.0), w)
    return photometric.stereo_error(depth, torch.tensor(BASELINE, dtype=depth.dtype), variance)


def phone_errors(light_lux: float, f_number: float, depths: Tensor) -> tuple[Tensor, Tensor]:
    """Give what a pair and a lens of the phone's cameras may claim, mm, infinite where they have lost the texture."""
    scene, radius = replace(OFFICE, light_lux=light_lux), LENS.focal_length / (2 * f_number)
    layout = ml.Layout([[0.0, 0.0], [BASELINE, 0.0]], [radius] * 2, [FOCUS] * 2)
    stereo = ml.PhotometricStereo(scene)(layout, [LENS] * 2, depths)[0]
    defocus = ml.PhotometricDefocus(scene, POWER_CHANGE)(layout, [LENS] * 2, depths)[0]
    return stereo, defocus
