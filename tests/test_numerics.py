"""Smooth minima and maxima: their bounds, their limits, and what their docstrings say of their gradients."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import grad, gradcheck

from multilens.numerics import soft_maximum, soft_minimum

ROUNDING = 1e-12
"""Relative; the logarithms of values up to 1e9 are divided by temperatures down to 0.01."""

columns = st.lists(st.floats(1e-6, 1e9), min_size=1, max_size=8)
temperatures = st.floats(0.01, 2.0)


def column(numbers: list[float]) -> torch.Tensor:
    return torch.tensor(numbers, dtype=torch.float64).unsqueeze(-1)


@given(columns, temperatures)
def test_soft_minimum_is_below_the_minimum_by_a_known_factor_at_most(numbers, temperature):
    ratio = soft_minimum(column(numbers), temperature).item() / min(numbers)
    assert len(numbers) ** -temperature * (1 - ROUNDING) <= ratio <= 1 + ROUNDING


@given(columns, temperatures, st.floats(1e-3, 1e3))
def test_soft_minimum_scales_as_its_values_do(numbers, temperature, factor):
    scaled = soft_minimum(factor * column(numbers), temperature)
    torch.testing.assert_close(scaled, factor * soft_minimum(column(numbers), temperature), rtol=ROUNDING, atol=0)


def test_soft_minimum_tends_to_the_minimum():
    values = column([3.0, 3.1, 700.0])
    distance = [3.0 - soft_minimum(values, temperature).item() for temperature in (0.3, 0.1, 0.03, 0.01)]
    assert distance == sorted(distance, reverse=True)
    assert distance[-1] < 0.01 * distance[0]


def test_at_temperature_one_it_is_inverse_variance_fusion():
    # Two measurements of variance 3 and 6: the best weighted mean has variance 1 / (1/3 + 1/6) = 2.
    assert soft_minimum(column([3.0, 6.0]), 1.0).item() == pytest.approx(2.0)


@given(columns, columns, temperatures)
def test_a_soft_minimum_of_soft_minima_is_that_of_all(first, second, temperature):
    apart = torch.stack([soft_minimum(column(numbers), temperature) for numbers in (first, second)])
    together = soft_minimum(column(first + second), temperature)
    torch.testing.assert_close(soft_minimum(apart, temperature), together, rtol=ROUNDING, atol=0)


def test_gradient_is_shared_in_proportion_to_a_power_of_the_values():
    values = column([2.0, 3.0, 5.0]).requires_grad_()
    (slope,) = grad(soft_minimum(values, 0.5).sum(), values)
    power = values.detach() ** (-1 / 0.5 - 1)
    torch.testing.assert_close(slope / slope.sum(), power / power.sum(), rtol=ROUNDING, atol=0)


def test_at_a_tie_each_has_the_same_share():
    values = column([4.0, 4.0, 4.0]).requires_grad_()
    (slope,) = grad(soft_minimum(values, 0.1).sum(), values)
    torch.testing.assert_close(slope, slope[0].expand(3, 1))


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("numbers", [[0.0, 5.0], [0.0, 0.0], [0.0]], ids=str)
def test_at_zero_value_and_gradient_are_finite(numbers, dtype):
    values = torch.tensor(numbers, dtype=dtype).unsqueeze(-1).requires_grad_()
    envelope = soft_minimum(values, 0.02)
    (slope,) = grad(envelope.sum(), values)
    assert 0 <= envelope.item() < 1e-29
    assert slope.isfinite().all()


def test_gradients():
    values = (
        torch.rand(2, 4, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(0)).add(0.1).requires_grad_()
    )
    assert gradcheck(lambda v: soft_minimum(v, 0.2), values)
    assert gradcheck(lambda v: soft_maximum(v, 0.2), values)


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=8), st.floats(0.01, 10.0))
def test_soft_maximum_is_above_the_maximum_by_a_known_distance_at_most(numbers, width):
    above = soft_maximum(torch.tensor(numbers, dtype=torch.float64), width).item() - max(numbers)
    assert -1e-9 <= above <= width * torch.tensor(float(len(numbers))).log().item() + 1e-6 * width + 1e-9


def test_gradient_of_the_soft_maximum_is_a_softmax():
    values = torch.tensor([1.0, 2.0, 2.0], dtype=torch.float64, requires_grad=True)
    (slope,) = grad(soft_maximum(values, 0.5), values)
    torch.testing.assert_close(slope, (values.detach() / 0.5).softmax(-1))
