from itertools import combinations, permutations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.search import dealing
from multilens.search.dealing import Dealing

NEAR, FAR = 300.0, 1800.0


def errors(gain: float, slope: np.ndarray, foci: np.ndarray, depths: np.ndarray) -> np.ndarray:
    """Give the error of every focus, and last of stereo, at every depth."""
    defocus = slope[:, None] * depths * np.abs(depths - foci[:, None])
    return np.vstack([defocus, gain * depths**2])


def score(gain: float, slope: np.ndarray, foci: np.ndarray, depths: np.ndarray, weights: np.ndarray) -> float:
    return float((errors(gain, slope, foci, depths).min(0) ** 2 * weights).sum())


def cost_of_best_focus(slope: float, near: float, far: float, depths: np.ndarray, weights: np.ndarray) -> float:
    mine = weights * depths**2
    focus = np.clip((mine * depths).sum() / mine.sum(), near, far)
    return slope**2 * float((mine * (depths - focus) ** 2).sum())


def exhaustive(gain: float, slope: np.ndarray, depths: np.ndarray, weights: np.ndarray) -> float:
    """Give the least score there is: every way to give each depth to a focus or to stereo, each focus the best for its depths."""
    least = np.inf
    for dealt in product(range(len(slope) + 1), repeat=len(depths)):
        owner = np.array(dealt)
        left = owner == len(slope)
        total = (weights[left] * (gain * depths[left] ** 2) ** 2).sum()
        for lens in range(len(slope)):
            if (mine := owner == lens).any():
                total += cost_of_best_focus(slope[lens], 0, np.inf, depths[mine], weights[mine])
        least = min(least, total)
    return least


def in_stretches(
    gain: float, slope: np.ndarray, near: np.ndarray, far: np.ndarray, depths: np.ndarray, weights: np.ndarray
) -> float:
    """Give the least cost of one stretch for every lens in any order, with stereo before, between and after."""
    depths, weights = depths[order := depths.argsort()], weights[order]
    by_stereo = weights * (gain * depths**2) ** 2
    least = by_stereo.sum()
    for used in range(1, len(slope) + 1):
        for lenses in permutations(range(len(slope)), used):
            for ends in combinations(range(len(depths) + used), 2 * used):
                # Ends of one stretch differ; that of one may be the beginning of the next.
                cuts = [end - place // 2 for place, end in enumerate(ends)]
                stretches = [slice(cuts[2 * i], cuts[2 * i + 1]) for i in range(used)]
                total = by_stereo.sum()
                for lens, own in zip(lenses, stretches, strict=True):
                    if depths[own].size:
                        total -= by_stereo[own].sum()
                        total += cost_of_best_focus(slope[lens], near[lens], far[lens], depths[own], weights[own])
                least = min(least, total)
    return least


def drawn(seed: int, count: int) -> tuple[np.ndarray, np.ndarray, np.random.Generator]:
    random = np.random.default_rng(seed)
    return 300 * 6 ** random.random(count), random.random(count) + 0.05, random


def anywhere(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.full(count, 1.0), np.full(count, 1e6)


@given(st.integers(0, 2**31), st.integers(1, 3), st.floats(0.01, 2))
def test_no_way_to_deal_out_stretches_is_better(seed: int, count: int, gain: float) -> None:
    depths, weights, random = drawn(seed, 5)
    slope = random.choice([0.5, 1.0, 3.0], count)
    near = random.uniform(NEAR, FAR, count)
    far = near + random.uniform(0, FAR, count)
    foci = Dealing(depths, weights).best_foci(gain, slope, near, far)
    found = score(gain, slope, foci, depths, weights)
    assert found <= in_stretches(gain, slope, near, far, depths, weights) * (1 + 1e-9)


@given(st.integers(0, 2**31), st.integers(1, 3), st.floats(0.01, 2))
def test_the_best_order_is_as_good_as_any_way_to_deal(seed: int, count: int, gain: float) -> None:
    depths, weights, random = drawn(seed, 5)
    slope = random.uniform(0.3, 3.0, count)
    near = random.uniform(NEAR, FAR, count)
    far, dealt = near + random.uniform(0, FAR, count), Dealing(depths, weights)
    scores = [
        score(gain, slope, dealt.best_in_order(gain, slope, near, far, np.array(order)), depths, weights)
        for order in permutations(range(count))
    ]
    assert min(scores) <= in_stretches(gain, slope, near, far, depths, weights) * (1 + 1e-9)


def test_many_unlike_lenses_keep_the_order_that_is_asked_for() -> None:
    random = np.random.default_rng(4)
    depths, order = np.linspace(300, 1800, 300), random.permutation(12)
    foci = Dealing(depths, np.full(300, 1 / 300)).best_in_order(np.inf, random.uniform(1, 2, 12), *anywhere(12), order)
    assert foci[order].tolist() == sorted(foci)


@pytest.mark.parametrize("seed", range(5))
def test_of_nearly_equal_lenses_no_foci_at_all_are_better(seed: int) -> None:
    depths, weights, random = drawn(seed, 7)
    slope = random.uniform(0.9, 1.1, 3)
    foci = Dealing(depths, weights).best_foci(0.05, slope, *anywhere(3))
    assert score(0.05, slope, foci, depths, weights) == pytest.approx(
        exhaustive(0.05, slope, depths, weights), rel=1e-9
    )


def test_without_stereo_all_depths_are_dealt_to_lenses() -> None:
    depths, weights, _ = drawn(3, 7)
    slope = np.array([1.0, 1.05])
    foci = Dealing(depths, weights).best_foci(np.inf, slope, *anywhere(2))
    assert score(1e9, slope, foci, depths, weights) == pytest.approx(exhaustive(1e9, slope, depths, weights), rel=1e-9)


def test_a_focus_that_is_fixed_stays_and_others_go_round_it() -> None:
    depths, slope = np.linspace(300, 1800, 400), np.ones(2)
    weights = np.full(400, 1 / 400)
    near, far = np.array([1500.0, NEAR]), np.array([1500.0, FAR])
    foci = Dealing(depths, weights).best_foci(np.inf, slope, near, far)
    others = np.linspace(NEAR, FAR, 1501)
    least = min(score(1e9, slope, np.array([1500.0, other]), depths, weights) for other in others)
    assert foci[0] == 1500.0
    assert score(1e9, slope, foci, depths, weights) <= least


def test_more_lenses_than_depths_are_left_over_within_their_bounds() -> None:
    foci = Dealing(np.array([500.0]), np.ones(1)).best_foci(0.1, np.ones(3), np.full(3, 400.0), np.full(3, 450.0))
    assert ((foci >= 400) & (foci <= 450)).all()


def test_lenses_that_are_too_many_to_tell_apart_count_as_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    depths, weights, random = drawn(1, 64)
    slope = random.uniform(0.9, 1.1, 6)
    dealt = Dealing(depths, weights)
    apart = score(0.1, slope, dealt.best_foci(0.1, slope, *anywhere(6)), depths, weights)
    monkeypatch.setattr(dealing, "MOST_WORK", 1)
    alike = score(0.1, slope, dealt.best_foci(0.1, slope, *anywhere(6)), depths, weights)
    assert apart <= alike <= 1.5 * apart


def test_of_many_depths_few_may_end_a_stretch(monkeypatch: pytest.MonkeyPatch) -> None:
    depths = np.geomspace(300, 1800, 600)
    weights, slope = np.full(600, 1 / 600), np.array([1.0, 1.0, 1.2])
    every = Dealing(depths, weights).best_foci(0.3, slope, *anywhere(3))
    monkeypatch.setattr(dealing, "MOST_ENDS", 100)
    few = Dealing(depths, weights).best_foci(0.3, slope, *anywhere(3))
    first, second = (score(0.3, slope, foci, depths, weights) for foci in (every, few))
    assert second == pytest.approx(first, rel=0.01)
