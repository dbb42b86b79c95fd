"""The smooth view of a texture that fades: where it is the claimed one, where it bends, and its written-out derivatives."""

import torch
from torch import Tensor
from torch.autograd import grad, gradcheck

from multilens.cues.fading import CEILING, FADE, faded, fading_in_focus
from multilens.optics.texture import FINEST, log_diffraction_transfer

STILL = torch.zeros(1, 1, dtype=torch.float64)


def at(y: Tensor) -> Tensor:
    """Give the faded error of a texture in focus."""
    return faded(y.reshape(1, -1), STILL, torch.zeros(1, y.numel(), dtype=y.dtype)).flatten()


def around(middle: float, side: float = 1e-6) -> Tensor:
    return torch.tensor([middle - side, middle + side], dtype=torch.float64, requires_grad=True)


def light(*numbers: float) -> list[Tensor]:
    return [torch.full((1, 1), number, dtype=torch.float64) for number in numbers]


def test_well_ahead_of_the_cliff_it_is_what_is_claimed():
    y = torch.linspace(-20, -FADE, 50, dtype=torch.float64)
    torch.testing.assert_close(at(y), y.exp())


def test_it_is_nowhere_less_than_what_is_claimed():
    y = torch.linspace(-20, 0, 500, dtype=torch.float64)
    assert (at(y) >= y.exp() * (1 - 1e-12)).all()


def test_at_the_cliff_it_is_as_good_as_none():
    assert at(torch.zeros(1, dtype=torch.float64)).sqrt() > 100


def test_it_rises_everywhere():
    y = torch.linspace(-20, 1e4, 5000, dtype=torch.float64)
    assert (at(y).diff() > 0).all()


def test_it_has_no_corner_at_the_bend_or_the_ceiling():
    # The ceiling is met where y and its bend are 16 together: y = 0.15.
    meets = next(y for y in torch.linspace(0, 1, 10_001).tolist() if y + 12 * (1 + y / FADE) ** 2 >= CEILING)
    for middle in (-FADE, meets):
        y = around(middle)
        before, after = grad(at(y).sum(), y)[0]
        torch.testing.assert_close(before, after, rtol=1e-2, atol=0)


def test_it_is_finite_in_single_precision_however_wide_the_blur():
    reach = torch.tensor([[1e4]], requires_grad=True)
    error = faded(torch.zeros(1, 1), reach, torch.tensor([[0.1]]))
    assert error.isfinite().all()
    assert grad(error.sum(), reach)[0].isfinite().all()


def test_blur_adds_its_square():
    y, reach, defocus = (torch.tensor([[x]], dtype=torch.float64) for x in (-9.0, 1000.0, 2e-3))
    torch.testing.assert_close(faded(y, reach, defocus), (y + 4).exp())


def test_in_focus_it_is_noise_and_diffraction_well_ahead_of_its_edge():
    radius = torch.tensor([[[1.0]]], dtype=torch.float64)
    y = fading_in_focus(radius, *light(100.0, 6000.0, 3.0, 0.2, -5.0))
    noise = (100 + 9) / 100**2
    transfer = log_diffraction_transfer(torch.tensor(0.2, dtype=torch.float64))
    torch.testing.assert_close(y.squeeze(), torch.tensor(noise).double().log() - 2 * transfer - 5)


def test_at_the_finest_texture_an_aperture_passes_it_is_as_good_as_none():
    finest, coarse = (fading_in_focus(*light(1.0, 1e9, 1e9, 0.0, x, 0.0)) for x in (FINEST, 0.9 * FINEST))
    assert finest - coarse > 12


def test_gradients():
    random = torch.Generator().manual_seed(0)
    y = torch.linspace(-8, 8, 24, dtype=torch.float64).reshape(2, 3, 4) - 0.1
    reach = torch.rand(2, 3, 1, dtype=torch.float64, generator=random)
    defocus = torch.randn(2, 3, 4, dtype=torch.float64, generator=random)
    unknowns = [y, y[..., :1].clone(), reach, reach.expand(2, 3, 4).clone(), defocus]
    y, in_focus, one, each, defocus = (x.requires_grad_() for x in unknowns)
    assert gradcheck(lambda *x: faded(*x).log(), (in_focus, one, defocus), rtol=1e-5)
    assert gradcheck(lambda *x: faded(*x).log(), (y, each, defocus), rtol=1e-5)


def test_gradients_in_focus():
    # Narrow and wide of the cutoff's edge, dark and full; on the sensor and, with a column for each depth, on the object.
    radius = torch.tensor([0.9, 1.03, 1.6, 4.0, 9.0], dtype=torch.float64).reshape(5, 1, 1).requires_grad_()
    fixed = light(100.0, 6000.0, 3.0, 1.0, -5.0)
    assert gradcheck(lambda a: fading_in_focus(a, *fixed), radius)
    by_depth = torch.tensor([[0.3, 0.98, 2.0]], dtype=torch.float64)
    assert gradcheck(lambda a: fading_in_focus(a, *fixed[:3], by_depth, -by_depth), radius)
