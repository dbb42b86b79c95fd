"""The mean of a tail, against the definition by a threshold."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens.tail import tail_mean

EVEN = torch.full((5,), 0.2, dtype=torch.float64)
VALUES = torch.tensor([3.0, -1.0, 4.0, 1.0, 5.0], dtype=torch.float64)


def test_level_0_is_the_mean_and_level_1_the_worst():
    assert tail_mean(VALUES, EVEN, 0.0).item() == pytest.approx(2.4)
    assert tail_mean(VALUES, EVEN, 1.0).item() == 5


def test_of_the_worst_half_of_five_the_third_counts_half():
    # Half of the probability is the worst two and half of the third.
    assert tail_mean(VALUES, EVEN, 0.5).item() == pytest.approx((5 + 4 + 3 / 2) / 2.5)


def test_what_cannot_happen_does_not_count():
    never = torch.tensor([0.25, 0.25, 0.25, 0.25, 0.0], dtype=torch.float64)
    assert tail_mean(VALUES, never, 1.0).item() == 4
    assert tail_mean(VALUES, never, 0.9).item() == pytest.approx(4)


@given(st.lists(st.tuples(st.floats(-10, 10), st.floats(0.01, 1)), min_size=1, max_size=8), st.floats(0, 0.99))
def test_it_is_the_least_over_thresholds_of_the_threshold_and_what_exceeds_it(
    outcomes: list[tuple[float, float]], level: float
):
    values, likely = torch.tensor(outcomes, dtype=torch.float64).T
    likely = likely / likely.sum()
    # Rockafellar and Uryasev: the least is taken on at one of the values.
    excess = (values - values.unsqueeze(-1)).clamp(min=0)
    least = (values + (excess * likely).sum(-1) / (1 - level)).min()
    assert tail_mean(values, likely, level).item() == pytest.approx(least.item(), abs=1e-9)


def test_the_gradient_is_that_of_the_tail():
    assert gradcheck(lambda values: tail_mean(values, EVEN, 0.7), VALUES.clone().requires_grad_())
