"""Photometric bounds against noisy images, the thesis' equation 8.1 and limits worked by hand."""

from math import exp, pi, sqrt

import pytest
import torch
from torch import Tensor
from torch.autograd import gradcheck

from multilens.optics.photometric import (
    defocus_error,
    direction_variance,
    equivalent_baseline,
    printed_defocus_error,
    stereo_error,
)
from multilens.optics.stereo import stereo_sensitivity
from multilens.optics.texture import amplitude_error, blur_spread, defocus_transfer

S, F, ZF, W = 1.0, 12.0, 800.0, 150.0
"""Spread of the aperture, focal length and in-focus depth in mm; rad of phase per mm of sensor."""
CONTRAST, NOISE, PIXELS, CHANGE = 0.3, 0.01, 200, 6e-5
DRAWS = 20_000
SAMPLING = 0.02
"""Four times by how much the standard deviation of 20,000 numbers is off, 1 part in 200."""


def double(*numbers: float) -> list[Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


def amplitude(defocus: float) -> float:
    """Of a sinusoid behind a Gaussian blur: its mean under that Gaussian, in closed form."""
    return CONTRAST * exp(-((W * S * F * defocus) ** 2) / 2)


def fitted(true_amplitude: float, random: torch.Generator) -> Tensor:
    """Fit a sinusoid of unknown phase and amplitude to many noisy images of it, and give each one's complex amplitude."""
    phase = torch.arange(PIXELS).double() / PIXELS * 2 * pi * 7
    waves = torch.stack([phase.cos(), phase.sin()], -1)
    images = true_amplitude * phase.cos() + NOISE * torch.randn(DRAWS, PIXELS, dtype=torch.float64, generator=random)
    return torch.complex(*(images @ waves * 2 / PIXELS).unbind(-1))


def error_squared(depth: float, power: float) -> Tensor:
    z, zf = double(depth, 1 / (1 / ZF + power))
    left = CONTRAST * defocus_transfer(torch.tensor(W), blur_spread(*double(S, F), zf, z))
    return amplitude_error(torch.tensor(NOISE), PIXELS, left) ** 2


def bound(depth: float, change: float) -> float:
    (z,) = double(depth)
    errors = error_squared(depth, change / 2) + error_squared(depth, -change / 2)
    (sharpness,) = double((W * F * S) ** 2)
    return defocus_error(z, 1 / z - 1 / ZF, sharpness, change, errors, 0.0).item()


@pytest.mark.parametrize("depth", [400.0, 600.0, 800.0, 1000.0, 2000.0])
def test_differential_defocus_of_two_noisy_images_errs_by_the_bound(depth: float):
    random = torch.Generator().manual_seed(int(depth))
    u = 1 / depth - 1 / ZF
    first, second = (fitted(amplitude(u + half), random).abs() for half in (-CHANGE / 2, CHANGE / 2))
    # The thesis' reading: Q = Bf / (w^2 B), and 1/Z is linear in it.
    q = (first - second) / (W**2 * (first + second) / 2)
    read = 1 / ZF + q / (CHANGE * S**2 * F**2)
    assert read.std().item() * depth**2 == pytest.approx(bound(depth, CHANGE), rel=SAMPLING)


@pytest.mark.parametrize("depth", [500.0, 800.0, 1500.0])
def test_a_large_change_of_focus_errs_by_the_bound_too(depth: float):
    random = torch.Generator().manual_seed(int(depth))
    u, change = 1 / depth - 1 / ZF, 1e-3
    first, second = (fitted(amplitude(u + half), random).abs() for half in (-change / 2, change / 2))
    read = (first / second).log() / (W * S * F) ** 2 / change
    assert read.mean().item() == pytest.approx(u, abs=read.std().item() * 0.05)
    assert read.std().item() * depth**2 == pytest.approx(bound(depth, change), rel=SAMPLING)


@pytest.mark.parametrize("depth", [400.0, 700.0, 1000.0, 2000.0])
def test_a_small_change_of_focus_gives_equation_8_1_with_the_errors_of_a_sensor(depth: float):
    u, change = 1 / depth - 1 / ZF, 1e-6
    b = amplitude(u)
    e_b, e_bf = NOISE * sqrt(2 / PIXELS), NOISE * sqrt(4 / PIXELS)
    bf = change * S**2 * F**2 * abs(u) * W**2 * b
    printed = printed_defocus_error(*double(depth, ZF), 0.0, e_b / b, e_bf / bf).item()
    assert bound(depth, change) == pytest.approx(printed, rel=1e-3)


def test_the_bound_is_finite_in_focus_where_equation_8_1_is_nothing_times_infinity():
    expected = ZF**2 * 2 * NOISE / sqrt(PIXELS) / (CONTRAST * (W * F * S) ** 2 * CHANGE)
    # The blur of half the change on either side, exp(k dP^2 / 8), adds 0.15 %.
    assert bound(ZF, CHANGE) == pytest.approx(expected, rel=2e-3)


def test_an_error_of_the_frequency_counts_twice_and_only_out_of_focus():
    z, k, errors = double(500.0, 1e6, 0.0)
    off = defocus_error(z, 1 / z - 1 / ZF, k, CHANGE, errors, 0.05).item()
    # 1/Z is linear in Q, and Q falls with the square of the frequency: Z^2 |u| 2 e_w/w.
    assert off == pytest.approx(500 * abs(500 - ZF) / ZF * 2 * 0.05)
    assert defocus_error(z, torch.zeros_like(z), k, CHANGE, errors, 0.05).item() == 0


@pytest.mark.parametrize("left", [0.3, 0.1, 0.03])
def test_stereo_errs_as_least_squares_phase_does(left: float):
    random = torch.Generator().manual_seed(7)
    shift = (fitted(left, random).angle() - fitted(left, random).angle()) / W
    r = amplitude_error(*double(NOISE), PIXELS, torch.tensor(left).double())
    variance = 2 * direction_variance(r**2, *double(W * F))
    z, b = double(700.0, 20.0)
    # A shift dx on the sensor is Z = b f / dx: as the thesis' equation 4.3 has it.
    expected = stereo_sensitivity(z, b, *double(F)).item() * shift.std().item()
    assert stereo_error(z, b, variance).item() == pytest.approx(expected, rel=SAMPLING)


def test_defocus_in_focus_is_stereo_with_the_equivalent_baseline():
    variance = direction_variance(error_squared(ZF, CHANGE / 2) + error_squared(ZF, -CHANGE / 2), *double(W * F))
    baseline = equivalent_baseline(*double(W * F, S), CHANGE)
    assert stereo_error(*double(ZF), baseline, variance).item() == pytest.approx(bound(ZF, CHANGE), rel=1e-12)


def test_defocus_at_its_best_is_stereo_across_three_tenths_of_the_aperture():
    # The best change of focus is 2 / (w S): there the equivalent baseline is 2 S, a half of the disc's diameter 4 S, and the blur
    # of either image costs exp(1/2).
    changes = torch.linspace(1e-5, 5e-3, 2000, dtype=torch.float64)
    best = min(bound(ZF, change) for change in changes.tolist())
    sharp = amplitude_error(torch.tensor(NOISE), PIXELS, torch.tensor(CONTRAST).double()) ** 2
    stereo = stereo_error(*double(ZF, 4 * S), 2 * direction_variance(sharp, *double(W * F))).item()
    assert stereo / best == pytest.approx(exp(-0.5) / 2, rel=1e-4)


def test_in_focus_the_error_falls_with_the_square_of_the_aperture():
    z, errors = double(800.0, 1e-4)
    narrow, wide = (defocus_error(z, 0 * z, (W * F * s) ** 2 * torch.ones_like(z), CHANGE, errors, 0.0) for s in (1, 2))
    torch.testing.assert_close(narrow, 4 * wide)


def test_the_printed_form_is_zero_in_focus_and_in_proportion_to_blur_nearby():
    at = [printed_defocus_error(*double(z, 1000.0), 0.01, 0.02, 0.03).item() for z in (1000.0, 1001.0, 1002.0)]
    assert at[0] == 0
    assert at[2] / at[1] == pytest.approx(2, rel=2e-3)


def test_gradients():
    z, u, k, e, v, b, w, s, zf = (
        x.requires_grad_() for x in double(500.0, 1e-3, 1e5, 1e-3, 1e-6, 20.0, 900.0, 1.0, 8e2)
    )
    assert gradcheck(lambda *x: defocus_error(*x[:3], 1e-4, x[3], 0.05), (z, u, k, e), rtol=1e-4)
    assert gradcheck(direction_variance, (e, w))
    assert gradcheck(stereo_error, (z, b, v), eps=1e-8, rtol=1e-4)
    assert gradcheck(lambda *x: equivalent_baseline(*x, 1e-4), (w, s))
    assert gradcheck(lambda *x: printed_defocus_error(*x, 0.01, 0.02, 0.03), (z, zf))
