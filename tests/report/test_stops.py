from dataclasses import replace
from math import hypot

import pytest
import torch

from multilens.bands import NOTHING, winner_bands
from multilens.cues import LimitedStereo, PairLimits
from multilens.field_of_view import Field
from multilens.fusion import InverseVariance
from multilens.report.stops import MOST_DEPTHS, stops, what_counts

EXACT = 1e-12
"""Relative; the same numbers in another order of operations."""


@pytest.fixture(scope="module")
def found(design):
    return stops(design.problem, design.layout)


def test_the_stops_ascend_and_hold_every_depth_of_the_problem(design, found):
    depths = [stop.depth for stop in found]
    assert depths == sorted(set(depths))
    assert set(design.problem.depths.tolist()) <= set(depths)


def test_in_focus_the_lens_wins_without_an_error(found):
    by_depth = {stop.depth: stop for stop in found}
    assert [by_depth[focus].measurement.label for focus in (900.0, 3000.0, 4500.0)] == [
        "defocus 2 tier 1",
        "defocus 1",
        "defocus 2 tier 2",
    ]
    assert all(by_depth[focus].error == 0 for focus in (400.0, 900.0, 3000.0, 4500.0))


def test_the_winner_is_the_one_with_the_least_error(design, found):
    problem, layout = design.problem, design.layout
    by_depth = {stop.depth: stop for stop in found}
    labels = [problem.measurements[k].label for k in problem.winners(layout).tolist()]
    assert [by_depth[depth].measurement.label for depth in problem.depths.tolist()] == labels
    least = [by_depth[depth].error for depth in problem.depths.tolist()]
    assert least == pytest.approx(problem.errors(layout).amin(0).tolist(), rel=EXACT)


def test_every_band_has_a_stop(design, found):
    for band in winner_bands(design.problem, design.layout):
        assert any(band.near <= stop.depth <= band.far and stop.measurement == band.measurement for stop in found)


def test_the_baseline_is_the_distance_of_the_pair(found):
    stereo = next(stop for stop in found if stop.measurement.label == "stereo 1-2")
    assert stereo.baseline == pytest.approx(hypot(42, 72), rel=EXACT)
    assert next(stop for stop in found if len(stop.measurement.lenses) == 1).baseline is None


def test_the_blur_is_that_of_similar_triangles(found):
    stop = next(stop for stop in found if stop.measurement.label == "defocus 1" and stop.depth > 3000)
    sensor, image = 1 / (1 / 6.86 - 1 / 3000), 1 / (1 / 6.86 - 1 / stop.depth)
    assert stop.blur == pytest.approx([2 * 1.93 * abs(sensor - image) / image], rel=1e-6)


def test_a_pair_is_told_by_its_sharpest_tier(found):
    stop = next(stop for stop in found if stop.measurement.label == "stereo 1-2" and stop.depth < 850)
    sensor = 1 / (1 / 6.86 - 1 / 900)
    assert stop.blur[1] == pytest.approx(2 * 1.5 * sensor * abs(1 / 900 - 1 / stop.depth), rel=1e-9)


def test_a_focus_nearer_than_the_focal_length_has_no_blur_to_tell(design):
    lenses = [replace(lens, focal_length=5000.0) for lens in design.problem.lenses]
    problem = replace(design.problem, lenses=lenses)
    assert {blur for stop in stops(problem, design.layout) for blur in stop.blur} == {None}


def test_where_nothing_measures_nothing_is_told_but_the_guess(design):
    problem = replace(design.problem, cues=[LimitedStereo(PairLimits(max_disparity=0.3))])
    nearest = stops(problem, design.layout)[0]
    assert (nearest.measurement, nearest.error, nearest.blur) == (NOTHING, None, ())
    assert nearest.counted == pytest.approx(problem.prior_error, rel=EXACT)


def test_what_counts_is_what_the_problem_counts(design):
    problem = replace(design.problem, fusion=InverseVariance(), field=Field.rings(80, 2))
    assert what_counts(problem) == "all measurements together, over the field"
    assert what_counts(design.problem) == ""
    counted = torch.tensor([stop.counted for stop in stops(problem, design.layout)], dtype=torch.float64)
    depths = torch.tensor([stop.depth for stop in stops(problem, design.layout)], dtype=torch.float64)
    assert torch.equal(counted, problem.squared_error(design.layout, depths).sqrt())


def test_of_many_depths_some_are_chosen_with_both_ends(design):
    problem = replace(design.problem, depths=torch.linspace(200, 5000, 3000, dtype=torch.float64), weights=None)
    depths = [stop.depth for stop in stops(problem, design.layout)]
    assert (depths[0], depths[-1]) == (200, 5000)
    assert MOST_DEPTHS <= len(depths) < MOST_DEPTHS + 50
