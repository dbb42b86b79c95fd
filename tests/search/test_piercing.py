"""Foci for the worst case against every combination of foci on a grid, and against closed forms."""

from itertools import combinations_with_replacement

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from multilens.search.piercing import Piercing

DEPTHS = torch.linspace(300, 900, 25, dtype=torch.float64)


def worst(gain: float, slope: float, weights: torch.Tensor, foci: torch.Tensor) -> torch.Tensor:
    """Give the largest weighted squared error for each row of foci."""
    stereo = (gain * DEPTHS**2).expand(*foci.shape[:-1], -1)
    defocus = slope * DEPTHS * (DEPTHS - foci.unsqueeze(-1)).abs()
    return (torch.minimum(stereo, defocus.amin(-2)).square() * weights).amax(-1)


@given(st.floats(1e-6, 1e-4), st.floats(1e-4, 1e-3), st.integers(1, 3), st.integers(0, 2**31))
def test_no_foci_on_a_grid_are_better(gain, slope, count, seed):
    weights = torch.rand(25, dtype=torch.float64, generator=torch.Generator().manual_seed(seed))
    grid = torch.linspace(300, 900, 41, dtype=torch.float64)
    tried = torch.stack([torch.stack(foci) for foci in combinations_with_replacement(grid, count)])
    given_gain, given_slope = (torch.tensor([number], dtype=torch.float64) for number in (gain, slope))
    found = Piercing(DEPTHS, weights).best_foci(given_gain, given_slope, count)
    assert worst(gain, slope, weights, found)[0] <= worst(gain, slope, weights, tried).min() * (1 + 1e-9)


def test_a_single_focus_makes_both_ends_equally_bad():
    none, slope = torch.tensor([torch.inf], dtype=torch.float64), torch.tensor([1e-4], dtype=torch.float64)
    depths = torch.linspace(500, 900, 25, dtype=torch.float64)
    found = Piercing(depths, torch.ones_like(depths)).best_foci(none, slope, 1)
    assert found.item() == pytest.approx((500**2 + 900**2) / (500 + 900), rel=1e-9)


def test_depths_without_weight_do_not_count():
    none, slope = torch.tensor([torch.inf], dtype=torch.float64), torch.tensor([1e-4], dtype=torch.float64)
    found = Piercing(DEPTHS, (DEPTHS <= 600).double()).best_foci(none, slope, 1)
    assert found.item() == pytest.approx((300**2 + 600**2) / (300 + 600), rel=1e-9)


def test_layouts_of_a_batch_do_not_know_of_each_other():
    gain, slope = torch.tensor([1e-5, 5e-5, torch.inf]).double(), torch.tensor([1e-4, 3e-4, 2e-4]).double()
    piercing = Piercing(DEPTHS, torch.ones_like(DEPTHS))
    alone = torch.cat([piercing.best_foci(gain[i : i + 1], slope[i : i + 1], 2) for i in range(3)])
    torch.testing.assert_close(piercing.best_foci(gain, slope, 2), alone, rtol=1e-9, atol=0)
