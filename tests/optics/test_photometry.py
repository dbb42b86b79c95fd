"""Light and noise against photographers' figures, scaling laws and drawn electrons."""

import pytest
import torch
from torch.autograd import gradcheck

from multilens.optics.photometry import exposed, photoelectrons, relative_noise_squared


def double(*numbers: float) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


def test_a_grey_card_in_sunlight_is_rightly_exposed_by_the_sunny_sixteen_rule():
    # In sunlight, 80,000 lux, f/16 and 1/100 s suit a film of 100 ISO: about 10 / ISO = 0.1 lux seconds on mid grey, give or
    # take half a stop. A pixel of 1 um then gets 409 photons.
    radius = 50 / (2 * 16)
    collected = photoelectrons(80_000, 0.18, 10.0, *double(1.0, 0.001, radius, 50.0))
    assert collected.item() == pytest.approx(0.1 * 4092, rel=0.5)


def test_the_image_of_a_white_surface_is_as_bright_as_the_camera_equation_has_it():
    # E = pi L / (4 N^2) with the luminance L = lux / pi; a lux second is 4.09e9 photons of 555 nm on a square mm.
    f, n, pitch = 6.86, 1.78, 0.00122
    expected = 500 / (4 * n**2) / 30 * 4.092e9 * pitch**2
    collected = photoelectrons(500, 1.0, 1000 / 30, *double(1.0, pitch, f / (2 * n), f))
    assert collected.item() == pytest.approx(expected, rel=1e-3)


def test_an_aperture_twice_as_wide_gathers_four_times_the_light():
    narrow, wide = (photoelectrons(300, 0.18, 30, *double(0.5, 0.001, a, 7.0)) for a in (0.7, 1.4))
    torch.testing.assert_close(wide, 4 * narrow)


def test_the_bright_places_of_an_exposure_just_fill_the_well():
    signal = exposed(*double(1e9, 6000.0), contrast=0.25)
    assert signal.item() * 1.25 == pytest.approx(6000)


def test_a_weak_signal_is_left_as_it_is():
    assert exposed(*double(100.0, 6000.0), contrast=0.25).item() == 100


def test_noise_is_that_of_drawn_electrons():
    random = torch.Generator().manual_seed(0)
    drawn = torch.poisson(torch.full((400_000,), 50.0, dtype=torch.float64), generator=random)
    drawn += 4.0 * torch.randn(drawn.shape, dtype=torch.float64, generator=random)
    # A variance of 400,000 numbers is off by 1 part in 450.
    assert relative_noise_squared(*double(50.0, 4.0)).item() == pytest.approx(drawn.var().item() / 50**2, rel=0.01)


def test_gradients():
    e, p, a, f, w, s = (x.requires_grad_() for x in double(0.5, 0.0012, 1.5, 6.0, 6000.0, 2.0))
    assert gradcheck(lambda *x: photoelectrons(300, 0.18, 30, *x), (e, p, a, f), rtol=1e-4)
    assert gradcheck(lambda x: exposed(x, w, 0.3), (torch.tensor([100.0, 9000.0]).double().requires_grad_(),))
    assert gradcheck(relative_noise_squared, (w, s))
