"""Stereo against its inverse, its own derivative and a published camera."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import grad, gradcheck

from multilens.optics.stereo import depth_to_disparity, disparity_to_depth, pair_angular_noise, stereo_sensitivity

ROUNDING = 1e-12
"""Relative; a few dozen roundings of double precision."""

depths = st.floats(10.0, 1e5)
baselines = st.floats(0.1, 500.0)
focal_lengths = st.floats(1.0, 100.0)


def double(*numbers: float) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


def test_depth_of_the_oak_d(truths):
    camera = truths["luxonis_oak_d"]
    depth = disparity_to_depth(*double(camera["disparity_px"], camera["baseline_mm"], camera["focal_px"]))
    # The vendor prints whole millimetres.
    assert depth.item() == pytest.approx(camera["depth_mm"], abs=0.5)


@given(depths, baselines, focal_lengths)
def test_disparity_leads_back_to_the_depth(depth, baseline, focal_length):
    z, b, f = double(depth, baseline, focal_length)
    torch.testing.assert_close(disparity_to_depth(depth_to_disparity(z, b, f), b, f), z, rtol=ROUNDING, atol=0)


@given(depths, baselines, focal_lengths)
def test_sensitivity_is_the_derivative_of_the_depth(depth, baseline, focal_length):
    z, b, f = double(depth, baseline, focal_length)
    disparity = depth_to_disparity(z, b, f).requires_grad_()
    (slope,) = grad(disparity_to_depth(disparity, b, f), disparity)
    torch.testing.assert_close(stereo_sensitivity(z, b, f), slope.abs(), rtol=ROUNDING, atol=0)


def test_twice_the_depth_is_four_times_as_hard():
    z, b, f = double(500.0, 20.0, 6.0)
    assert stereo_sensitivity(2 * z, b, f) == 4 * stereo_sensitivity(z, b, f)


@given(st.floats(1e-6, 1.0))
def test_equal_lenses_keep_their_noise(noise):
    n = double(noise)[0]
    torch.testing.assert_close(pair_angular_noise(n, n), n, rtol=ROUNDING, atol=0)


@given(st.floats(1e-6, 1.0), st.floats(1e-6, 1.0))
def test_noise_of_a_pair_lies_between_its_lenses(first, second):
    noise = pair_angular_noise(*double(first, second)).item()
    assert min(first, second) * (1 - ROUNDING) <= noise <= max(first, second) * (1 + ROUNDING)


def test_noise_of_a_pair_is_that_of_simulated_errors():
    # Errors of the two shifts are independent; their difference, over root two, is what equal lenses would have each.
    errors = torch.randn(2, 200_000, generator=torch.Generator().manual_seed(0), dtype=torch.float64)
    difference = 0.03 * errors[0] - 0.04 * errors[1]
    simulated = difference.std() / 2**0.5
    # The standard deviation of a standard deviation is 1 / sqrt(2 n) of it: five times that.
    torch.testing.assert_close(
        pair_angular_noise(*double(0.03, 0.04)), simulated, rtol=5 / (2 * 200_000) ** 0.5, atol=0
    )


def test_gradients():
    arguments = [x.requires_grad_() for x in double(500.0, 20.0, 6.0)]
    assert gradcheck(disparity_to_depth, arguments)
    assert gradcheck(depth_to_disparity, arguments)
    assert gradcheck(stereo_sensitivity, arguments)
    assert gradcheck(pair_angular_noise, arguments[1:])
