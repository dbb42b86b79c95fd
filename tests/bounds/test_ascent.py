"""The bound of the worth that was found, against the exact best score of equal and of two unequal foci."""

import numpy as np
import pytest

from multilens.bounds.ascent import Focus, best_worth
from multilens.bounds.contiguous import best_scores, stretch_costs
from multilens.bounds.cut import Depths, most_saved, stereo_left

LINEAR = Depths(np.linspace(20.0, 50.0, 128), np.full(128, 1 / 128))
LOGARITHMIC = Depths(np.geomspace(200.0, 5000.0, 256), np.full(256, 1 / 256))


def bound(depths: Depths, foci: tuple[Focus, ...], baseline: float) -> float:
    worth = best_worth(depths, foci, baseline)
    saved = sum(focus.count * most_saved(depths, worth, focus.aperture, focus.focus_range) for focus in foci)
    return stereo_left(depths, worth, np.array([baseline]))[0] - saved


@pytest.mark.parametrize(
    ("depths", "aperture", "baseline", "count"),
    [(LINEAR, 23.0, 27.0, 3), (LINEAR, 24.0, 30.0, 4), (LOGARITHMIC, 3.86, 150.0, 4), (LOGARITHMIC, 40.0, 60.0, 2)],
)
def test_for_equal_apertures_it_comes_close_to_the_best_score_from_below(depths, aperture, baseline, count):
    whole = (float(depths.depth[0]), float(depths.depth[-1]))
    best = best_scores(depths.stereo / baseline**2, stretch_costs(depths, aperture, whole), count)[-1]
    # The gap is that of the climb, which has few steps; it was 0.1 to 1.5 % for these.
    assert 0.97 * best <= bound(depths, (Focus(aperture, whole, count),), baseline) <= best


def test_for_two_unequal_apertures_it_comes_close_to_exhaustive_search():
    foci = np.linspace(20.0, 50.0, 301)
    wide, narrow = (LINEAR.slope / a**2 * (LINEAR.depth - foci[:, None]) ** 2 for a in (30.0, 12.0))
    stereo = LINEAR.stereo / 33.0**2
    best = min(np.minimum(np.minimum(stereo, row), narrow).sum(1).min() for row in wide)
    found = bound(LINEAR, (Focus(30.0, (20.0, 50.0), 1), Focus(12.0, (20.0, 50.0), 1)), 33.0)
    assert 0.93 * best <= found <= best


def test_without_stereo_one_focus_is_bounded_closely():
    centre = (LINEAR.weight * LINEAR.depth**3).sum() / (LINEAR.weight * LINEAR.depth**2).sum()
    best = (LINEAR.slope * (LINEAR.depth - centre) ** 2).sum() / 25.0**2
    assert 0.97 * best <= bound(LINEAR, (Focus(25.0, (20.0, 50.0), 1),), 0.0) <= best
