"""Equation 8.1 as printed, as a cue."""

import pytest
import torch
from torch.autograd import gradcheck

from multilens import Layout, Lens, PrintedDefocus
from multilens.cues import Cue, LimitedCue

LENS = Lens(6.0, (0.5, 3.0))
CUE = PrintedDefocus(frequency_error=0.03, amplitude_error=0.0, change_error=0.08)


def test_errors_are_worked_out_by_hand():
    # sqrt(4 * 0.03^2 + 0.08^2) = 0.1, times 500 * 500 / 1000 and 2000 * 1000 / 1000.
    z = torch.tensor([500.0, 1000.0, 2000.0], dtype=torch.float64)
    errors = CUE(Layout([[0.0, 0.0]], [1.0], [1000.0]), [LENS], z)
    torch.testing.assert_close(errors, torch.tensor([[25.0, 0.0, 200.0]], dtype=torch.float64))


def test_it_is_a_cue_that_never_fails():
    assert isinstance(CUE, Cue)
    assert not isinstance(CUE, LimitedCue)


def test_every_tier_measures_with_its_own_focus():
    z = torch.tensor([500.0, 1000.0], dtype=torch.float64)
    errors = CUE(Layout([[0.0, 0.0]], [1.0], [[500.0, 1000.0]]), [Lens(6.0, (0.5, 3.0), tiers=2)], z)
    assert (errors == 0).tolist() == [[True, False], [False, True]]


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ((-1.0, 0.0, 0.1), "frequency_error must be >= 0 and finite, got -1"),
        ((0.0, -1.0, 0.1), "amplitude_error must be >= 0 and finite, got -1"),
        ((0.0, 0.0, 0.0), "change_error must be > 0 and finite, got 0"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(numbers, message):
    with pytest.raises(ValueError, match=message):
        PrintedDefocus(*numbers)


def test_gradients():
    focus = torch.tensor([[[700.0], [1200.0]]], dtype=torch.float64, requires_grad=True)
    z = torch.tensor([500.0, 1000.0], dtype=torch.float64)
    assert gradcheck(
        lambda x: CUE(Layout(torch.zeros(1, 2, 2).double(), torch.ones(1, 2).double(), x), [LENS] * 2, z), focus
    )
