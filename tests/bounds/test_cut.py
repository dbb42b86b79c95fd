"""Cuts against the score itself, against exhaustive search over foci, and their tables against each entry."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.bounds.cut import Depths, focus_grid, most_saved, savings, stereo_left

ROUNDING = 1e-12
RANGE = (100.0, 400.0)


def some_depths(random: np.random.Generator, count: int = 12) -> Depths:
    weight = random.uniform(0.1, 1, count)
    return Depths(np.sort(random.uniform(*RANGE, count)), weight / weight.sum())


def costs(depths: Depths, aperture: float, focus: float) -> np.ndarray:
    return depths.weight * (depths.depth * (depths.depth - focus) / aperture) ** 2


@given(st.integers(0, 2**31))
def test_no_foci_score_below_any_cut(seed):
    random = np.random.default_rng(seed)
    depths = some_depths(random)
    apertures, foci = random.uniform(5, 50, 3), random.uniform(*RANGE, 3)
    baseline = random.uniform(10, 200)
    stereo = depths.weight * depths.depth**4 / baseline**2
    score = np.min([stereo, *(costs(depths, a, f) for a, f in zip(apertures, foci, strict=True))], axis=0).sum()
    worth = stereo * random.uniform(0, 2, len(stereo)) * random.uniform(0, 1)
    saved = sum(most_saved(depths, worth, float(a), RANGE) for a in apertures)
    cut = stereo_left(depths, worth, np.array([baseline]))[0] - saved
    assert cut <= score * (1 + ROUNDING)


@given(st.integers(0, 2**31), st.floats(2, 200))
def test_what_a_focus_saves_is_no_less_than_the_most_of_a_fine_search_and_hardly_more(seed, aperture):
    random = np.random.default_rng(seed)
    depths = some_depths(random)
    worth = random.uniform(0, 1, 12) * depths.weight * 1e4
    most = max(np.maximum(worth - costs(depths, aperture, focus), 0).sum() for focus in np.linspace(*RANGE, 4_001))
    bound = most_saved(depths, worth, aperture, RANGE)
    # The grid of foci is as fine as the bands are wide, but for a cap; a search in steps of 0.075 mm misses a little itself.
    assert most * (1 - ROUNDING) <= bound <= most * 1.03


def test_a_lens_of_one_focus_saves_what_it_saves():
    depths = Depths(np.array([100.0, 200.0]), np.array([0.5, 0.5]))
    worth = np.array([1.0, 3.0])
    # At 200 mm nothing is lost; at 100 mm the cost is 0.5 (100 * 100 / 1e4)^2 = 0.5.
    assert most_saved(depths, worth, 1e4, (200.0, 200.0)) == pytest.approx(3.0 + 0.5)


def test_a_focus_nearer_than_every_depth_saves_at_the_first_alone():
    depths = Depths(np.array([100.0, 200.0, 300.0]), np.array([0.5, 0.25, 0.25]))
    # At 100 mm from a focus at 50 mm the cost is 0.5 (100 * 50 / 4e3)^2 = 25/32; farther away it exceeds the worth.
    assert most_saved(depths, np.array([1.0, 0.01, 0.01]), 4e3, (50.0, 50.0)) == pytest.approx(7 / 32)


@given(st.integers(0, 2**31))
def test_interpolated_savings_are_no_less_than_computed_ones(seed):
    random = np.random.default_rng(seed)
    depths = some_depths(random)
    worth = random.uniform(0, 1, 12) * depths.weight * 1e4
    apertures = np.linspace(5, 100, 97)
    table = savings(depths, worth, apertures, RANGE, evaluated=9)
    grid = focus_grid(depths, worth, 100.0, RANGE)
    exact = [grid.saved(worth, float(a)).sum(1).max() for a in apertures]
    assert (table >= np.array(exact) * (1 - ROUNDING)).all()


def test_without_a_baseline_all_worth_is_left():
    depths = some_depths(np.random.default_rng(1))
    assert stereo_left(depths, np.ones(12), np.array([0.0])).tolist() == [12.0]
