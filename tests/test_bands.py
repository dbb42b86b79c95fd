from itertools import pairwise

import pytest
import torch

from multilens.back import Back
from multilens.bands import NOTHING, dense_depths, winner_bands
from multilens.cues import LimitedStereo, PairLimits
from multilens.depths import linear_depths, log_depths
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.defocus import defocus_band
from multilens.problem import Problem

LENS = Lens(6.0, (0.5, 4.0), focus=(100, 10000))
BACK = Back.rectangle(100, 100)
RELATIVE_ROUNDING = 1e-9


def problem_of(count, depths):
    return Problem(BACK, [LENS] * count, depths)


@pytest.mark.parametrize("samples", [3, 20, 300])
def test_defocus_wins_over_its_closed_form_band(samples):
    layout = Layout([(10, 50), (40, 50)], [2.0, 1.0], [800.0, 9000.0])
    bands = winner_bands(problem_of(2, log_depths(200, 2000, samples)), layout)
    near, far = defocus_band(*(torch.tensor(value, dtype=torch.float64) for value in (800.0, 2.0, 30.0)))
    assert [band.measurement.label for band in bands] == ["stereo 1-2", "defocus 1", "stereo 1-2"]
    assert bands[1].near == pytest.approx(near.item(), rel=RELATIVE_ROUNDING)
    assert bands[1].far == pytest.approx(far.item(), rel=RELATIVE_ROUNDING)


def test_bands_tile_the_range_of_depths():
    layout = Layout([(10, 50), (40, 50), (20, 20)], [2.0, 1.0, 3.0], [800.0, 2000.0, 300.0])
    bands = winner_bands(problem_of(3, log_depths(200, 5000, 64)), layout)
    assert (bands[0].near, bands[-1].far) == (200.0, pytest.approx(5000.0))
    assert [band.far for band in bands[:-1]] == [band.near for band in bands[1:]]


def test_no_band_is_empty_and_no_two_neighbours_are_alike():
    layout = Layout([(10, 50), (40, 50), (20, 20)], [2.0, 1.0, 3.0], [800.0, 2000.0, 300.0])
    bands = winner_bands(problem_of(3, log_depths(200, 5000, 64)), layout)
    assert all(band.near < band.far for band in bands)
    assert all(a.measurement != b.measurement for a, b in pairwise(bands))


def test_a_win_between_two_depths_is_found_at_its_focus():
    layout = Layout([(0, 0), (90, 0)], [0.5, 0.5], [700.0, 9000.0])
    bands = winner_bands(problem_of(2, [500.0, 1000.0]), layout)
    assert [band.measurement.label for band in bands] == ["stereo 1-2", "defocus 1", "stereo 1-2"]


def test_equal_lenses_do_not_take_turns():
    layout = Layout([(0, 0), (0.1, 0), (0, 0.1)], [2.0] * 3, [800.0] * 3)
    bands = winner_bands(problem_of(3, linear_depths(700, 900, 50)), layout)
    assert [band.measurement.label for band in bands] == ["defocus 1"]


def test_a_third_that_leads_where_two_cross_has_its_band():
    # Equal apertures, foci 400, 450 and 500: each leads from the harmonic-like midpoint (Z - a = b - Z) to the next.
    layout = Layout([(0, 0), (1e-3, 0), (0, 1e-3)], [2.0] * 3, [400.0, 450.0, 500.0])
    bands = winner_bands(problem_of(3, [400.0, 500.0]), layout)
    assert [band.far for band in bands[:-1]] == pytest.approx([425.0, 475.0], rel=RELATIVE_ROUNDING)


def test_a_single_depth_has_a_single_band():
    (band,) = winner_bands(problem_of(2, [500.0]), Layout([(0, 0), (30, 0)], [1.0, 1.0], [900.0, 900.0]))
    assert (band.near, band.far, band.measurement.label) == (500.0, 500.0, "stereo 1-2")


def test_dense_depths_hold_the_problems_own():
    problem = problem_of(1, [900.0, 300.0, 300.0])
    depths = dense_depths(problem, Layout([(0, 0)], [1.0], [555.5]))
    assert {300.0, 555.5, 900.0} <= set(depths.tolist())


def limited(depths, **limits):
    return Problem(BACK, [LENS] * 3, depths, cues=[LimitedStereo(PairLimits(**limits))])


def test_pairs_take_over_where_they_begin_to_work_and_nothing_measures_before():
    # A parallax of 0.6 / 6 = 0.1: baselines of 30, 60 and 90 mm work from 300, 600 and 900 mm on.
    layout = Layout([(0, 0), (30, 0), (90, 0)], [1.0] * 3, [800.0] * 3)
    bands = winner_bands(limited(log_depths(200, 2000, 40), max_disparity=0.6), layout)
    assert [band.measurement.label for band in bands] == ["nothing", "stereo 1-2", "stereo 2-3", "stereo 1-3"]
    assert [band.near for band in bands] == pytest.approx([200, 300, 600, 900], rel=RELATIVE_ROUNDING)


def test_where_nothing_ever_measures_there_is_one_band_of_nothing():
    layout = Layout([(0, 0), (30, 0), (90, 0)], [1.0] * 3, [800.0] * 3)
    (band,) = winner_bands(limited([200.0, 250.0], max_disparity=0.6), layout)
    assert (band.near, band.far, band.measurement) == (200.0, 250.0, NOTHING)
