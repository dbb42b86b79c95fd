from itertools import product
from typing import Any

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor

import multilens as ml
from multilens.search.stretches import MOST_ENDS, Stretches

INFINITE = torch.tensor([torch.inf], dtype=torch.float64)


def score(gain: Tensor, foci: Tensor, depths: Tensor, weights: Tensor) -> float:
    """Give the score of foci of slope 1, by the error of every cue at every depth."""
    defocus = depths * (depths - foci.unsqueeze(-1)).abs()
    errors = torch.cat([defocus, (gain * depths**2).unsqueeze(0)])
    return (errors.amin(0).square() * weights).sum().item()


def exhaustive(gain: float, count: int, depths: Tensor, weights: Tensor) -> float:
    """Give the least score there is: every way to give each depth to a focus or to stereo, each focus the best for its depths."""
    dealt = torch.tensor(list(product(range(count + 1), repeat=len(depths))), dtype=torch.long)
    total = torch.where(dealt == count, gain**2 * depths**4 * weights, 0).sum(-1)
    for focus in range(count):
        mine = (dealt == focus) * weights * depths**2
        best = (mine * depths).sum(-1) / mine.sum(-1).clamp(min=1e-300)
        total = total + (mine * (depths - best.unsqueeze(-1)).square()).sum(-1)
    return total.min().item()


def drawn(seed: int, count: int) -> tuple[Tensor, Tensor]:
    random = torch.Generator().manual_seed(seed)
    depths = 300 * 6 ** torch.rand(count, dtype=torch.float64, generator=random)
    return depths, torch.rand(count, dtype=torch.float64, generator=random) + 0.05


@given(st.integers(0, 2**31), st.integers(1, 3), st.floats(0.005, 0.5))
def test_no_way_to_deal_the_depths_is_better(seed: int, count: int, gain: float) -> None:
    depths, weights = drawn(seed, 7)
    one = torch.ones(1, dtype=torch.float64)
    (foci,) = Stretches(depths, weights).best_foci(gain * one, one, count)
    assert score(gain * one, foci, depths, weights) == pytest.approx(exhaustive(gain, count, depths, weights), rel=1e-9)


@given(st.integers(0, 2**31), st.integers(1, 3))
def test_nor_without_stereo(seed: int, count: int) -> None:
    depths, weights = drawn(seed, 7)
    (foci,) = Stretches(depths, weights).best_foci(INFINITE, torch.ones(1, dtype=torch.float64), count)
    # As dear as makes no difference, and yet a number.
    assert score(INFINITE, foci, depths, weights) == pytest.approx(exhaustive(1e9, count, depths, weights), rel=1e-9)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_foci_are_near_the_published(count: int, truths: dict[str, Any]) -> None:
    depths = ml.linear_depths(200, 2000, 4001)
    (foci,) = Stretches(depths, torch.ones(4001).double()).best_foci(INFINITE, torch.ones(1).double(), count)
    published = torch.tensor(truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]["foci"]).double()
    # Stretches begin and end at every 42nd depth, every 19 mm.
    torch.testing.assert_close(foci / 1000, published, rtol=0, atol=0.019)


def test_only_the_ratio_of_gain_and_slope_counts() -> None:
    stretches = Stretches(*drawn(1, 40))
    gain, slope = torch.tensor([0.02, 0.2], dtype=torch.float64), torch.tensor([0.1, 1.0], dtype=torch.float64)
    one, other = stretches.best_foci(gain, slope, 3)
    torch.testing.assert_close(one, other, rtol=1e-12, atol=0)


def test_each_of_a_batch_has_its_own() -> None:
    stretches = Stretches(*drawn(2, 40))
    gain = torch.tensor([0.01, 0.1, torch.inf], dtype=torch.float64)
    together = stretches.best_foci(gain, torch.ones(3).double(), 2)
    alone = torch.cat([stretches.best_foci(each[None], torch.ones(1).double(), 2) for each in gain])
    assert together.equal(alone)


def test_depths_in_any_order_give_the_same() -> None:
    depths, weights = drawn(3, 30)
    order = torch.randperm(30, generator=torch.Generator().manual_seed(0))
    gain, slope = torch.tensor([0.05], dtype=torch.float64), torch.ones(1, dtype=torch.float64)
    one, other = (Stretches(depths[at], weights[at]).best_foci(gain, slope, 3) for at in (order, order.flip(0)))
    torch.testing.assert_close(one, other, rtol=1e-12, atol=0)


@pytest.mark.parametrize("gain", [torch.inf, 0.1, 1e-9])
@pytest.mark.parametrize("count", [2, 3, 5])
def test_more_foci_than_depths_have_every_depth_in_focus(count: int, gain: float) -> None:
    depths = torch.tensor([300.0, 500.0], dtype=torch.float64)
    one = torch.ones(1, dtype=torch.float64)
    foci = Stretches(depths, torch.ones(2).double()).best_foci(gain * one, one, count)
    assert set(foci.flatten().tolist()) == {300.0, 500.0}


def test_depths_of_no_weight_do_not_count() -> None:
    depths, weights = drawn(5, 7)
    gain, slope = torch.tensor([0.05], dtype=torch.float64), torch.ones(1, dtype=torch.float64)
    weights[[1, 4, 5]] = 0
    (foci,) = Stretches(depths, weights).best_foci(gain, slope, 2)
    assert score(gain, foci, depths, weights) == pytest.approx(exhaustive(0.05, 2, depths, weights), rel=1e-9)


def test_the_work_does_not_grow_with_the_depths() -> None:
    assert Stretches(*drawn(4, 5000)).cost.shape == (MOST_ENDS + 1, MOST_ENDS + 1)
