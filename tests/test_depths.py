"""Depths spread over a range, and the weights of a histogram."""

from math import inf, nan

import pytest
import torch

from multilens.depths import histogram_weights, linear_depths, log_depths


@pytest.mark.parametrize("spread", [linear_depths, log_depths])
@pytest.mark.parametrize(("near", "far"), [(200.0, 5000.0), (0.1, 0.3), (33.3, 777.7)])
def test_depths_begin_and_end_exactly_where_asked(spread, near, far):
    depths = spread(near, far, 7)
    assert (depths[0].item(), depths[-1].item(), len(depths)) == (near, far, 7)


def test_linear_depths_are_a_step_apart():
    steps = linear_depths(100, 500, 5).diff()
    torch.testing.assert_close(steps, torch.full((4,), 100.0, dtype=torch.float64))


def test_log_depths_are_a_factor_apart():
    depths = log_depths(100, 1600, 5)
    torch.testing.assert_close(depths[1:] / depths[:-1], torch.full((4,), 2.0, dtype=torch.float64))


@pytest.mark.parametrize("spread", [linear_depths, log_depths])
@pytest.mark.parametrize(
    ("near", "far", "count", "name"),
    [(0.0, 1.0, 8, "near"), (nan, 1.0, 8, "near"), (2.0, 1.0, 8, "far"), (1.0, inf, 8, "far"), (1.0, 2.0, 1, "count")],
)
def test_a_range_that_is_none_is_refused_by_name(spread, near, far, count, name):
    with pytest.raises(ValueError, match=f"{name} must be"):
        spread(near, far, count)


def test_the_depths_of_a_bin_count_together_as_much_as_it():
    depths = linear_depths(100, 400, 31)
    weights = histogram_weights(depths, [100, 200, 250, 400], [2, 0, 6])
    assert weights[depths < 200].sum().item() == pytest.approx(0.25)
    assert weights[depths >= 250].sum().item() == pytest.approx(0.75)
    assert weights[(depths >= 200) & (depths < 250)].eq(0).all()


def test_within_a_bin_depths_count_alike():
    weights = histogram_weights(log_depths(100, 1600, 9), [100, 400, 1600], [1, 1])
    torch.testing.assert_close(weights, torch.tensor([1 / 8] * 4 + [1 / 10] * 5, dtype=torch.float64))


def test_depths_in_any_order_keep_their_weights():
    depths = linear_depths(100, 400, 7)
    shuffled = torch.tensor([3, 0, 6, 2, 5, 1, 4])
    weights = histogram_weights(depths, [100, 250, 400], [1, 3])
    assert histogram_weights(depths[shuffled], [100, 250, 400], [1, 3]).equal(weights[shuffled])


@pytest.mark.parametrize(("edges", "message"), [([150, 400], "enclose"), ([100, 110, 120, 400], "every bin")])
def test_a_histogram_that_does_not_fit_is_refused(edges, message):
    with pytest.raises(ValueError, match=message):
        histogram_weights(linear_depths(100, 400, 7), edges, [1.0] * (len(edges) - 1))


@pytest.mark.parametrize(
    ("edges", "shares", "message"),
    [
        ([100, 400], [], "shares must be one fewer than edges, at least one, got 0 and 2"),
        ([100, 250, 400], [1], "shares must be one fewer than edges, at least one, got 1 and 3"),
        ([100, 300, 200, 400], [1, 1, 1], "edges must ascend"),
        ([100, nan, 400], [1, 1], "edges must ascend"),
        ([100, 250, 400], [1, -1], "shares must be finite and >= 0, not all 0"),
        ([100, 250, 400], [1, nan], "shares must be finite and >= 0, not all 0"),
        ([100, 250, 400], [0, 0], "shares must be finite and >= 0, not all 0"),
    ],
)
def test_what_is_no_histogram_is_refused(edges, shares, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        histogram_weights(linear_depths(100, 400, 7), edges, shares)
