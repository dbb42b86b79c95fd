import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import approx_fprime

from multilens.search.gapless import Gapless


def curves(seed: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Give Vs over 20 to 50 mm, the last with its tip at 0, as stereo has it."""
    random = np.random.default_rng(seed)
    return random.uniform(0.01, 0.3, count), np.append(random.uniform(15, 60, count - 1), 0.0)


def test_it_is_the_integral_of_the_least_square() -> None:
    slope, tip = curves(3, 4)
    mean = Gapless(np.linspace(20.5, 49.5, 30), np.full(30, 1 / 30))

    def least(depth: float) -> float:
        return float(((slope * depth * (depth - tip)) ** 2).min()) / 30

    expected, _ = quad(least, 20, 50, limit=500, epsabs=1e-12)
    value, _, _ = mean(slope, tip)
    # Quadrature meets kinks where the winner changes.
    assert value == pytest.approx(expected, rel=1e-6)


@given(st.integers(0, 2**31), st.integers(2, 7))
def test_many_depths_are_nearly_without_gaps(seed: int, count: int) -> None:
    slope, tip = curves(seed, count)
    depths, weights = np.linspace(20, 50, 4000), np.full(4000, 1 / 4000)
    squares = (slope[:, None] * depths * (depths - tip[:, None])) ** 2
    value, _, _ = Gapless(depths, weights)(slope, tip)
    # A sum over so many depths is off by the square of their distance and the weight of both ends.
    assert value == pytest.approx(squares.min(0) @ weights, rel=1e-4, abs=1e-6)


@given(st.integers(0, 2**31), st.integers(1, 6))
def test_its_gradient_is_that_of_differences(seed: int, count: int) -> None:
    slope, tip = curves(seed, count)
    mean = Gapless(np.linspace(20, 50, 12), np.arange(1.0, 13.0) / 78)
    _, by_slope, by_tip = mean(slope, tip)
    scale = np.abs(by_slope).max() + np.abs(by_tip).max()
    np.testing.assert_allclose(by_slope, approx_fprime(slope, lambda s: mean(s, tip)[0], 1e-8), atol=1e-4 * scale)
    np.testing.assert_allclose(by_tip, approx_fprime(tip, lambda t: mean(slope, t)[0], 1e-6), atol=1e-4 * scale)


def test_it_has_no_kink_where_a_depth_changes_hands() -> None:
    depths, weights = np.linspace(20, 50, 31), np.full(31, 1 / 31)
    tips = np.linspace(30.0, 32.0, 2001)
    slopes = [Gapless(depths, weights)(np.array([0.2, 0.02]), np.array([tip, 0.0]))[2][0] for tip in tips]
    assert np.abs(np.diff(slopes)).max() < 3 * np.abs(np.diff(slopes)).mean()


def test_depths_in_any_order_and_twice_count_the_same() -> None:
    slope, tip = curves(1, 3)
    depths, weights = np.array([20.0, 30.0, 40.0, 50.0]), np.array([0.1, 0.2, 0.4, 0.3])
    shuffled = Gapless(np.array([40.0, 20.0, 50.0, 30.0, 40.0]), np.array([0.3, 0.1, 0.3, 0.2, 0.1]))
    assert shuffled(slope, tip)[0] == pytest.approx(Gapless(depths, weights)(slope, tip)[0], rel=1e-12)
