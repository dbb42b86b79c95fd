"""The least of some values and its gradient against torch's own; the smooth maximum and the steep rise: bounds and gradients."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import grad, gradcheck

from multilens.numerics import least, soft_maximum, steep_rise

# Few different values, so that ties are common.
columns = st.lists(st.lists(st.integers(0, 3), min_size=4, max_size=4), min_size=1, max_size=6)


def by_torch(values: torch.Tensor, upstream: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    smallest = values.amin(-2)
    return smallest, grad(smallest, values, upstream)[0]


@given(columns)
def test_the_least_is_that_of_torch(rows):
    values = torch.tensor(rows, dtype=torch.float64)
    assert least(values).equal(values.amin(-2))


@given(columns)
def test_the_gradient_is_that_of_torch_also_at_ties(rows):
    values = torch.tensor(rows, dtype=torch.float64, requires_grad=True)
    upstream = torch.tensor([1.0, -2.0, 0.5, 3.0], dtype=torch.float64)
    (slope,) = grad(least(values), values, upstream)
    torch.testing.assert_close(slope, by_torch(values, upstream)[1], rtol=1e-15, atol=0)


def test_the_least_is_taken_in_each_batch_by_itself():
    values = torch.rand(3, 2, 5, 7, dtype=torch.float64, generator=torch.Generator().manual_seed(0)).requires_grad_()
    (slope,) = grad(least(values).sum(), values)
    assert slope.equal(by_torch(values, torch.ones(3, 2, 7).double())[1])


def test_least_passes_gradcheck():
    values = torch.rand(2, 4, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(0)).requires_grad_()
    assert gradcheck(least, values)


def test_the_least_keeps_the_type():
    assert least(torch.ones(2, 3, dtype=torch.float32)).dtype == torch.float32


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=8), st.floats(0.01, 10.0))
def test_soft_maximum_is_above_the_maximum_by_a_known_distance_at_most(numbers, width):
    above = soft_maximum(torch.tensor(numbers, dtype=torch.float64), width).item() - max(numbers)
    assert -1e-9 <= above <= width * torch.tensor(float(len(numbers))).log().item() + 1e-6 * width + 1e-9


def test_gradient_of_the_soft_maximum_is_a_softmax():
    values = torch.tensor([1.0, 2.0, 2.0], dtype=torch.float64, requires_grad=True)
    (slope,) = grad(soft_maximum(values, 0.5), values)
    torch.testing.assert_close(slope, (values.detach() / 0.5).softmax(-1))


def test_soft_maximum_passes_gradcheck():
    values = torch.rand(2, 4, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(0)).requires_grad_()
    assert gradcheck(lambda v: soft_maximum(v, 0.2), values)


@pytest.mark.parametrize("far", [1e8, -1e8])
def test_soft_maximum_of_values_far_from_zero_is_finite(far):
    assert soft_maximum(torch.full((3,), far, dtype=torch.float64), 1e-7).isfinite()


def test_the_rise_goes_from_zero_to_one_most_of_it_at_once():
    values = torch.tensor([-1.0, 0.0, 0.5, 1.0, 2.0], dtype=torch.float64)
    assert steep_rise(values).tolist() == [0, 0, 0.875, 1, 1]


def test_the_square_of_the_rise_has_no_corner():
    ends = torch.tensor([-1e-9, 1e-9, 1 - 1e-9, 1 + 1e-9], dtype=torch.float64, requires_grad=True)
    (slope,) = grad(steep_rise(ends).square().sum(), ends)
    assert slope.abs().max() < 1e-7


def test_the_rise_passes_gradcheck():
    values = torch.linspace(-0.51, 1.5, 40, dtype=torch.float64).requires_grad_()
    assert gradcheck(steep_rise, [values])
