"""What many views tell of depth, against least squares of noisy views and against pairs."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import gradcheck

from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.optics.many_views import view_information

seeds = st.integers(0, 2**31)


def drawn(seed: int, count: int) -> tuple[Tensor, Tensor]:
    """Places, mm, and standard deviations of the directions, rad."""
    random = torch.Generator().manual_seed(seed)
    numbers = torch.rand(count, 3, dtype=torch.float64, generator=random)
    return 50 * numbers[:, :2], 1e-4 * (0.2 + numbers[:, 2])


def design_matrix(place: Tensor, noise: Tensor) -> Tensor:
    """Rows of x and y of every view, over its noise, in the unknowns: direction along x and along y, 1/Z."""
    one, none = torch.ones(len(place), dtype=torch.float64), torch.zeros(len(place), dtype=torch.float64)
    along_x, along_y = torch.stack([one, none, -place[:, 0]], -1), torch.stack([none, one, -place[:, 1]], -1)
    return torch.cat([along_x / noise[:, None], along_y / noise[:, None]])


def informed(place: Tensor, noise: Tensor, usable: Tensor | None = None) -> Tensor:
    return view_information(pair_distance(place), noise.unsqueeze(-1) ** -2, usable)


@given(seeds, st.integers(2, 6))
def test_it_is_one_over_the_variance_of_weighted_least_squares(seed, count):
    place, noise = drawn(seed, count)
    matrix = design_matrix(place, noise)
    variance = torch.linalg.inv(matrix.T @ matrix)[2, 2]
    assert informed(place, noise).item() == pytest.approx(1 / variance.item(), rel=1e-6)


def test_noisy_views_of_a_point_scatter_so():
    place, noise = drawn(7, 4)
    random = torch.Generator().manual_seed(0)
    depth, draws = 800.0, 200_000
    seen = torch.cat([-place[:, 0], -place[:, 1]]) / depth + torch.tensor([0.1, -0.2]).double().repeat_interleave(4)
    scatter = noise.repeat(2)
    views = seen + scatter * torch.randn(draws, 8, dtype=torch.float64, generator=random)
    found = torch.linalg.lstsq(design_matrix(place, noise), (views / scatter).T).solution[2]
    # The standard deviation of 200 000 draws is known to 1 / sqrt(400 000), 0.16 %.
    assert found.std().item() == pytest.approx(informed(place, noise).item() ** -0.5, rel=6e-3)
    # To first order, as everywhere, the depth scatters by Z^2 as much.
    assert (1 / found).std().item() == pytest.approx(depth**2 * informed(place, noise).item() ** -0.5, rel=1e-2)


def test_equal_views_are_as_published():
    # sum (x - mean)^2 of 0, 10, 20, 30 mm is 500 mm^2.
    place = torch.tensor([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0], [30.0, 0.0]], dtype=torch.float64)
    noise = torch.full((4,), 1e-4, dtype=torch.float64)
    assert informed(place, noise).item() == pytest.approx(500 / 1e-8)


@given(seeds, st.integers(2, 5), seeds)
def test_it_lies_between_the_best_pair_and_all_views(seed, count, usable_seed):
    place, noise = drawn(seed, count)
    first, second = pair_indices(count)
    random = torch.Generator().manual_seed(usable_seed)
    usable = torch.rand(len(first), 3, dtype=torch.float64, generator=random)
    usable = usable * (usable > 0.3)
    found = informed(place, noise, usable)
    alone = usable * (pair_distance(place).square() / (noise[first] ** 2 + noise[second] ** 2)).unsqueeze(-1)
    assert (found >= alone.amax(0) * (1 - 1e-9)).all()
    assert (found <= informed(place, noise) * (1 + 1e-9)).all()


def test_a_lens_that_no_pair_may_use_is_as_if_it_were_not_there():
    place, noise = drawn(3, 4)
    first, second = pair_indices(4)
    usable = ((first != 2) & (second != 2)).double().unsqueeze(-1)
    others = torch.tensor([0, 1, 3])
    without = informed(place[others], noise[others])
    torch.testing.assert_close(informed(place, noise, usable), without, rtol=1e-12, atol=0)


def test_where_no_pair_may_be_used_nothing_is_told():
    place, noise = drawn(3, 3)
    usable = torch.zeros(3, 1, dtype=torch.float64, requires_grad=True)
    told = informed(place, noise, usable)
    assert told.item() == 0
    (slope,) = torch.autograd.grad(told.sum(), usable)
    assert slope.isfinite().all()


def test_two_lenses_used_in_part_tell_that_part():
    place, noise = drawn(5, 2)
    usable = torch.tensor([[0.25, 1.0]], dtype=torch.float64)
    torch.testing.assert_close(informed(place, noise, usable), usable[0] * informed(place, noise))


def test_the_gradient_is_right():
    place, noise = drawn(1, 4)
    usable = torch.rand(6, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(2)) * 0.6 + 0.2
    # In units of 1e8 mm^2, so that the numbers are of about 1.
    scaled = lambda p, n, u: informed(p, 1e-4 * n, u) / 1e8  # noqa: E731
    parts = (place, 1e4 * noise, usable)
    assert gradcheck(scaled, tuple(part.requires_grad_() for part in parts))
