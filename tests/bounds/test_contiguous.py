"""The dynamic programme against exhaustive search and against published values."""

from itertools import combinations_with_replacement

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from multilens.bounds.contiguous import best_scores, stretch_costs, worth_of_depths
from multilens.bounds.cut import Depths


def uniform(near: float, far: float, count: int) -> Depths:
    """Depths whose weighted mean is the mean over the range, by the trapezoidal rule."""
    weight = np.ones(count)
    weight[0] = weight[-1] = 0.5
    return Depths(np.linspace(near, far, count), weight / weight.sum())


@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_best_foci_have_the_published_score(truths, count):
    depths = uniform(0.2, 2.0, 401)
    # The truth is that of an effective aperture of 1 m; stereo is so bad that it is never used.
    found = best_scores(depths.stereo * 1e6, stretch_costs(depths, 1.0, (0.2, 2.0)), count)
    truth = truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]["J"]
    # The sum in 400 steps is off by the square of a step over that of the stretch that one focus serves.
    assert found[-1] == pytest.approx(truth, rel=1e-3)


@settings(max_examples=10)
@given(st.integers(0, 2**31))
def test_no_foci_on_a_fine_grid_are_better_and_the_best_of_them_are_as_good(seed):
    random = np.random.default_rng(seed)
    weight = random.uniform(0.1, 1, 8)
    depths = Depths(np.sort(random.uniform(100, 300, 8)), weight / weight.sum())
    stereo = depths.stereo / random.uniform(20, 200) ** 2
    foci = np.linspace(120, 280, 161)
    cost = depths.slope / 15.0**2 * (depths.depth - foci[:, None]) ** 2
    exhaustive = min(
        np.minimum(stereo, np.minimum(cost[i], cost[j])).sum()
        for i, j in combinations_with_replacement(range(len(foci)), 2)
    )
    found = best_scores(stereo, stretch_costs(depths, 15.0, (120.0, 280.0)), 2)[-1]
    # A focus half a step of 1 mm beside its best place costs that depth's error at 0.5 mm.
    assert found <= exhaustive * (1 + 1e-12)
    assert exhaustive - found <= (depths.slope / 15.0**2).sum() * 0.25


@given(st.integers(0, 2**31))
def test_the_worth_of_a_stretch_is_at_most_its_cost_and_the_price(seed):
    random = np.random.default_rng(seed)
    weight = random.uniform(0.1, 1, 10)
    depths = Depths(np.sort(random.uniform(100, 300, 10)), weight / weight.sum())
    stereo, stretch = depths.stereo / 50.0**2, stretch_costs(depths, 15.0, (100.0, 300.0))
    worth = np.concatenate([[0.0], np.cumsum(worth_of_depths(stereo, stretch, 20.0))])
    over = worth[None, :] - worth[:, None]
    later = np.triu_indices(11, 1)
    assert (over[later] <= stretch[later] + 20.0 + 1e-9).all()
