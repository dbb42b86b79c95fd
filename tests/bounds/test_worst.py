"""The least worst error against closed forms, against all foci on a grid, and against many layouts."""

from itertools import combinations_with_replacement
from math import inf, sqrt

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

import multilens as ml
from multilens.bounds.worst import Serving, least_worst
from multilens.metrics import InverseDepth, MeanSquare, Relative, WorstCase

DEPTHS = np.linspace(200.0, 1000.0, 81)
ANYWHERE = (1.0, 1e6)
RELATIVE = DEPTHS**-2.0
LOWERED = 1e-8
"""Relative: by how much the bound is lowered to be on the safe side of rounding, and a little."""


def test_stereo_alone_is_worst_at_the_far_end():
    found = least_worst(DEPTHS, np.ones(81), Serving(50.0, 0.0, 2, ANYWHERE))
    assert sqrt(found) == pytest.approx(1000**2 / 50, rel=LOWERED)


@pytest.mark.parametrize("foci", [1, 2, 4, 8])
def test_relative_errors_of_defocus_share_the_range_out_evenly(foci: int):
    # err / Z = |Z - Zf| / a; of 81 depths k foci serve 81 / k in a row each, from 10 mm to 10 mm.
    in_a_row = -(-81 // foci)
    found = least_worst(DEPTHS, RELATIVE, Serving(0.0, 7.0, foci, ANYWHERE))
    assert sqrt(found) == pytest.approx((in_a_row - 1) * 10 / 2 / 7.0, rel=LOWERED)


def test_stereo_takes_what_is_near_and_one_focus_the_rest():
    # Up to Zs stereo, Z / g; beyond it the focus in the middle, (1000 - Zs) / 2 a; Zs where both are one.
    g, a = 500.0, 700.0
    depths = np.linspace(200.0, 1000.0, 80001)
    share = 1000 / (2 * a / g + 1) / g
    found = least_worst(depths, depths**-2.0, Serving(g, a, 1, ANYWHERE))
    assert sqrt(found) == pytest.approx(share, rel=1e-4)


def test_a_focus_may_be_held_to_a_range():
    # In focus at 400 mm at the farthest: the worst is 1000 mm.
    found = least_worst(DEPTHS, RELATIVE, Serving(0.0, 7.0, 1, (100.0, 400.0)))
    assert sqrt(found) == pytest.approx(600 / 7.0, rel=LOWERED)


def test_as_many_foci_as_depths_leave_no_error():
    assert least_worst(DEPTHS[:4], np.ones(4), Serving(0.0, 7.0, 4, ANYWHERE)) < 1e-100


@given(
    depths=st.lists(st.integers(20, 60), min_size=2, max_size=7, unique=True),
    baseline=st.sampled_from([0.0, 3.0, 30.0]),
    foci=st.integers(1, 3),
    power=st.sampled_from([0.0, -2.0, -4.0]),
)
def test_no_foci_on_a_grid_are_better_and_the_best_are_near(
    depths: list[int], baseline: float, foci: int, power: float
):
    depth = np.array(sorted(depths), dtype=float)
    factor = depth**power
    grid = np.linspace(20, 60, 321)
    # No focus beyond the outer depths is of use; between two nodes the root of the score changes by less than a step does.
    each = factor * depth**2 * (depth - grid[:, None]) ** 2 / 5.0**2
    stereo = factor * depth**4 / baseline**2 if baseline else np.full(len(depth), inf)
    least = min(
        np.minimum(each[list(chosen)].min(0), stereo).max()
        for chosen in combinations_with_replacement(range(0, 321, 4), foci)
    )
    found = least_worst(depth, factor, Serving(baseline, 5.0, foci, ANYWHERE))
    step = (np.sqrt(factor) * depth).max() * 0.25 / 5.0
    assert found <= least * (1 + 1e-12)
    assert sqrt(found) >= sqrt(least) - step


@pytest.mark.parametrize("of", [MeanSquare(), Relative(), InverseDepth()])
def test_no_layout_is_better_than_the_bound_of_the_worst_case(of):
    lens = ml.Lens(5.0, (0.5, 2.5), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)
    other = ml.Lens(8.0, (0.5, 2.0), focus=(300, 900), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    back = ml.Back.rectangle(30, 20)
    problem = ml.Problem(back, [lens, lens, other], ml.log_depths(300, 2000, 64), metric=WorstCase(of))
    bound = ml.lower_bound(problem).value
    random = torch.Generator().manual_seed(1)
    position = torch.rand(4000, 3, 2, generator=random, dtype=torch.float64) * torch.tensor([30.0, 20.0])
    # Positions that break every limit but the back's own are allowed: the bound holds for those that keep it.
    low, high = torch.tensor([0.5, 0.5, 0.5]), torch.tensor([2.5, 2.5, 2.0])
    radius = low + (high - low) * torch.rand(4000, 3, generator=random, dtype=torch.float64)
    margin = (radius + torch.tensor([1.5, 1.5, 1.0])).unsqueeze(-1)
    position = torch.maximum(torch.minimum(position, torch.tensor([30.0, 20.0]) - margin), margin)
    near, far = torch.tensor([300.0, 300.0, 300.0]), torch.tensor([2000.0, 2000.0, 900.0])
    focus = near * (far / near) ** torch.rand(4000, 3, generator=random, dtype=torch.float64)
    assert bound is not None
    assert 0 < bound <= problem.score(ml.Layout(position, radius, focus)).min()


def test_one_lens_alone_comes_as_near_as_its_bound():
    # Relative error, one focus: half the range over 2 A f / n.
    lens = ml.Lens(5.0, (0.5, 2.0), blur_noise=1e-3)
    problem = ml.Problem(
        ml.Back.disc(10), [lens], ml.linear_depths(300, 900, 61), cues=[ml.LensDefocus()], metric=WorstCase(Relative())
    )
    assert sqrt(ml.lower_bound(problem).value) == pytest.approx(300 / (2 * 2.0 * 5.0 / 1e-3), rel=LOWERED)


def test_bodies_that_cannot_be_packed_are_told():
    lens = ml.Lens(5.0, (2.0, 3.0))
    problem = ml.Problem(ml.Back.rectangle(7, 5), [lens] * 2, [300.0], metric=WorstCase())
    assert ml.lower_bound(problem).reason == "no layout is feasible: the smallest apertures cannot be packed"
