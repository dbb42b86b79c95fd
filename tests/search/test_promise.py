from math import inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.search.promise import Promise

DEPTHS, WEIGHTS = np.linspace(20, 50, 3000), np.full(3000, 1 / 3000)


def test_many_lenses_keep_their_promise() -> None:
    # For an even density the best foci are known: ranges of Z^(5/3) shared out in equal parts, each focus in the middle of one.
    count, slope = 200, 3.0
    end = np.linspace(20 ** (5 / 3), 50 ** (5 / 3), count + 1) ** (3 / 5)
    foci = (end[1:] + end[:-1]) / 2
    score = ((slope * DEPTHS * np.abs(DEPTHS - foci[:, None]).min(0)) ** 2).mean()
    # 15 depths to each lens, and short stretches: both leave about a part of its number squared.
    assert Promise(DEPTHS, WEIGHTS)(np.array([inf]), np.array([count / slope])) == pytest.approx(score, rel=5e-3)


def test_stereo_alone_keeps_its_promise() -> None:
    promised = Promise(DEPTHS, WEIGHTS)(np.array([0.01]), np.zeros(1))
    assert promised == pytest.approx((0.01**2 * DEPTHS**4).mean(), rel=1e-6)


@given(st.floats(1e-4, 1.0), st.floats(0.1, 1e4))
def test_both_cues_promise_no_less_than_either(gain: float, width: float) -> None:
    promise = Promise(DEPTHS, WEIGHTS)
    both, stereo, defocus = promise(np.array([gain, gain, inf]), np.array([width, 0.0, width]))
    assert both <= min(stereo, defocus) * (1 + 1e-12)


@given(st.floats(1e-4, 1.0), st.floats(0.1, 1e4))
def test_twice_the_errors_are_four_times_the_score(gain: float, width: float) -> None:
    one, other = Promise(DEPTHS, WEIGHTS)(np.array([gain, 2 * gain]), np.array([width, width / 2]))
    assert other == pytest.approx(4 * one, rel=1e-9)


def test_depths_of_no_weight_cost_nothing() -> None:
    weights = np.where(DEPTHS > 30, WEIGHTS, 0)
    kept = DEPTHS > 30
    # What is left out of the range is half a distance between two depths.
    whole, part = Promise(DEPTHS, weights), Promise(DEPTHS[kept], WEIGHTS[kept])
    case = np.array([0.02]), np.array([5.0])
    assert whole(*case) == pytest.approx(part(*case), rel=1e-3)
