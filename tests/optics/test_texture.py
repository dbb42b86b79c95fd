"""What comes through against integrals over pixels, apertures and blur, and amplitudes of noisy sinusoids."""

from math import pi

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens.optics.defocus import depth_to_differential_blur
from multilens.optics.stereo import depth_to_disparity
from multilens.optics.texture import (
    FINEST,
    amplitude_error,
    blur_spread,
    cutoff_radius,
    defocus_transfer,
    log_diffraction_transfer,
    pixel_transfer,
)


def double(*numbers: float) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


def test_a_pixel_passes_the_mean_of_a_sinusoid_over_its_width():
    frequency, pitch = 150.0, 0.002
    across = (torch.arange(10_000).double() + 0.5) / 10_000 * pitch - pitch / 2
    mean = (2 * pi * frequency * across).cos().mean()
    torch.testing.assert_close(pixel_transfer(*double(frequency, pitch)), mean, rtol=1e-7, atol=0)


def test_at_the_nyquist_frequency_a_pixel_passes_two_over_pi():
    assert pixel_transfer(*double(250.0, 0.002)).item() == pytest.approx(2 / pi)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_diffraction_passes_what_two_shifted_apertures_share(share: float):
    # The transfer of an aperture is its autocorrelation: two unit discs whose centres lie 2 x apart.
    side = torch.linspace(-1, 1, 2001, dtype=torch.float64)
    x, y = torch.meshgrid(side, side, indexing="ij")
    both = (((x - share) ** 2 + y**2 < 1) & ((x + share) ** 2 + y**2 < 1)).double().mean() * 4 / pi
    # A grid of 2001 x 2001 misses up to a part in 1000 of the rim.
    assert log_diffraction_transfer(torch.tensor(share).double()).exp().item() == pytest.approx(both.item(), rel=0.02)


def test_the_cutoff_of_diffraction_is_one_over_wavelength_and_f_number():
    # f/2 in green light: 1 / (0.000555 * 2) cycles per mm of sensor.
    focal_length = torch.tensor(8.0, dtype=torch.float64)
    assert cutoff_radius(focal_length / (0.000555 * 2), 0.000555).item() == pytest.approx(8 / (2 * 2))


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_diffraction_is_finite_and_falls_with_a_slope_also_beyond_its_cutoff(dtype: torch.dtype):
    share = torch.linspace(0.01, 3, 500, dtype=dtype, requires_grad=True)
    transfer = log_diffraction_transfer(share)
    (slope,) = torch.autograd.grad(transfer.sum(), share)
    assert transfer.isfinite().all()
    assert (slope < 0).all()


def test_the_logarithm_of_diffraction_goes_on_without_a_kink():
    share = torch.tensor([FINEST - 1e-7, FINEST + 1e-7], dtype=torch.float64, requires_grad=True)
    before, after = torch.autograd.grad(log_diffraction_transfer(share).sum(), share)[0]
    torch.testing.assert_close(before, after, rtol=1e-4, atol=0)


def test_the_spread_of_blur_is_that_of_rays_through_the_aperture():
    radius, f, zf, z = 1.9, 6.9, 800.0, 500.0
    random = torch.Generator().manual_seed(0)
    angle, part = torch.rand(2, 400_000, generator=random, dtype=torch.float64)
    through = radius * part.sqrt() * (2 * pi * angle).cos()
    # The sensor stands where Zf is sharp for a power P = 1/f + 1/Zf: a ray from Z meets it where a straight line leads.
    power = 1 / f + 1 / zf
    met = through + f * through * (1 / z - power)
    spread = blur_spread(*double(radius / 2, f, zf, z))
    # A standard deviation of 400,000 numbers is off by 1 part in 900.
    assert spread.item() == pytest.approx(met.std().item(), rel=5e-3)


@given(st.floats(0.1, 5.0), st.floats(3.0, 30.0), st.floats(100.0, 1e4), st.floats(100.0, 1e4))
def test_the_discs_diameter_changes_with_depth_as_the_disparity_across_it(radius, focal_length, focus, depth):
    # Schechner and Kiryati: defocus with an aperture of diameter D is as sensitive as stereo with a baseline D.
    a, f, zf = double(radius, focal_length, focus)
    z = torch.tensor(depth, dtype=torch.float64, requires_grad=True)
    # An even disc of the diameter D has the standard deviation D / 4 along an axis.
    diameter = 4 * blur_spread(a / 2, f, zf, z)
    disparity = depth_to_disparity(z, 2 * a, f)
    (of_blur,) = torch.autograd.grad(diameter, z)
    (of_disparity,) = torch.autograd.grad(disparity, z)
    torch.testing.assert_close(of_blur, of_disparity, rtol=1e-9, atol=0)


def test_spread_is_half_the_radius_of_the_disc():
    torch.testing.assert_close(
        2 * blur_spread(*double(1.0, 6.9, 800.0, 500.0)), depth_to_differential_blur(*double(500.0, 6.9, 2.0, 800.0))
    )


def test_blur_leaves_of_a_sinusoid_its_mean_under_a_gaussian():
    random = torch.Generator().manual_seed(0)
    moved = torch.randn(400_000, dtype=torch.float64, generator=random) * 0.01
    # A mean of 400,000 cosines is off by less than 1 / 600.
    assert defocus_transfer(*double(120.0, 0.01)).item() == pytest.approx((120 * moved).cos().mean().item(), abs=5e-3)


def test_a_small_blur_of_a_disc_is_that_of_a_gaussian_of_half_its_radius():
    # The disc of radius a passes 2 J1(w a) / (w a), of which the first terms are 1 - (w a)^2 / 8.
    frequency, radius = double(20.0, 0.01)
    disc = 2 * torch.special.bessel_j1(frequency * radius) / (frequency * radius)
    assert defocus_transfer(frequency, radius / 2).item() == pytest.approx(disc.item(), abs=(0.2**4) / 100)


def test_the_error_of_an_amplitude_is_that_of_a_least_squares_fit():
    n, e, amplitude = 200, 0.02, 0.1
    phase = torch.arange(n).double() / n * 2 * pi * 10
    random = torch.Generator().manual_seed(0)
    images = amplitude * phase.cos() + e * torch.randn(40_000, n, dtype=torch.float64, generator=random)
    fit = torch.linalg.lstsq(torch.stack([phase.cos(), phase.sin()], -1), images.T).solution
    error = amplitude_error(torch.tensor(e), n, torch.tensor(amplitude)).item()
    # A standard deviation of 40,000 numbers is off by 1 part in 280.
    assert (fit.norm(dim=0) / amplitude).std().item() == pytest.approx(error, rel=0.02)
    assert torch.atan2(fit[1], fit[0]).std().item() == pytest.approx(error, rel=0.02)


def test_gradients():
    v, p, a, s, f, zf, z = (x.requires_grad_() for x in double(100.0, 0.0012, 1.5, 0.01, 6.0, 800.0, 500.0))
    assert gradcheck(pixel_transfer, (v, p), rtol=1e-4)
    assert gradcheck(lambda x: cutoff_radius(x, 0.000555), v)
    share = torch.tensor([0.2, 0.7, 1.4], dtype=torch.float64, requires_grad=True)
    assert gradcheck(log_diffraction_transfer, (share,))
    assert gradcheck(blur_spread, (a, f, zf, z))
    assert gradcheck(defocus_transfer, (v, s))
    assert gradcheck(lambda *x: amplitude_error(x[0], 200, x[1]), (s, a))
