"""Limited stereo against the thesis' stereo and hand-worked depths, and what its smooth errors promise."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens import Layout, Lens
from multilens.cues import FusedCue, LimitedCue, LimitedStereo, PairLimits, PairStereo

LENS = Lens(6.0, (0.5, 3.0), disparity_noise=0.001, field_of_view_deg=70.0)
LIMITED = LimitedStereo(PairLimits(max_disparity=0.6, least_overlap=0.5))
DEPTHS = torch.logspace(1.5, 4, 60, dtype=torch.float64)
places = st.lists(st.tuples(st.floats(-100, 100), st.floats(-100, 100)), min_size=3, max_size=3)


def standing(position) -> Layout:
    return Layout(position, [1.0] * len(position), [500.0] * len(position))


def test_a_wide_pair_fails_near_by_and_a_short_one_takes_over():
    # A parallax of 0.6 / 6 = 0.1: 20 mm work from 200 mm on, 60 mm from 600 mm, 80 mm from 800 mm.
    depths = torch.tensor([199.0, 300.0, 700.0, 900.0], dtype=torch.float64)
    errors = LIMITED(standing([[0.0, 0.0], [20.0, 0.0], [80.0, 0.0]]), [LENS] * 3, depths)
    labels = [m.label for m in LIMITED.measurements([LENS] * 3)]
    best = [labels[k] for k in errors.argmin(0)[1:]]
    assert not errors[:, 0].isfinite().any()
    assert best == ["stereo 1-2", "stereo 2-3", "stereo 1-3"]


@given(places)
def test_where_it_measures_it_is_the_stereo_of_the_thesis(position):
    layout = standing(position)
    errors, whole = LIMITED(layout, [LENS] * 3, DEPTHS), PairStereo()(layout, [LENS] * 3, DEPTHS)
    usable = LIMITED.limits.usable(layout, [LENS] * 3, DEPTHS)
    assert errors[usable].equal(whole[usable])
    assert errors[~usable].isinf().all()


@given(places)
def test_smooth_errors_are_finite_and_never_less(position):
    errors, smooth = (f(standing(position), [LENS] * 3, DEPTHS) for f in (LIMITED, LIMITED.smooth))
    assert smooth.isfinite().all()
    assert (smooth >= errors)[errors.isfinite()].all()


def test_without_limits_it_is_the_stereo_of_the_thesis():
    layout, free = standing([[0.0, 0.0], [20.0, 0.0]]), LimitedStereo()
    lenses = [Lens(6.0, (0.5, 3.0))] * 2
    assert free(layout, lenses, DEPTHS).equal(PairStereo()(layout, lenses, DEPTHS))
    assert free.smooth(layout, lenses, DEPTHS).equal(PairStereo()(layout, lenses, DEPTHS))


@given(places)
def test_all_views_together_tell_no_less_than_the_best_pair_and_no_more_than_without_limits(position):
    layout = standing(position)
    told = LIMITED.information(layout, [LENS] * 3, DEPTHS)
    best = LIMITED(layout, [LENS] * 3, DEPTHS).amin(-2)
    free = PairStereo().information(layout, [LENS] * 3, DEPTHS)
    assert (told >= best**-2 * (1 - 1e-12)).all()
    assert (told <= free * (1 + 1e-12)).all()


@given(places)
def test_what_a_search_counts_on_is_no_more_than_what_is_told(position):
    layout = standing(position)
    told, counted_on = (LIMITED.information(layout, [LENS] * 3, DEPTHS, smooth) for smooth in (False, True))
    assert (counted_on <= told * (1 + 1e-12)).all()


def test_it_is_a_limited_cue_and_a_fused_one():
    assert isinstance(LIMITED, LimitedCue)
    assert isinstance(LIMITED, FusedCue)


def test_gradients():
    position = torch.rand(2, 3, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0)) * 60
    radius = torch.ones(2, 3, dtype=torch.float64)

    def seen(place: torch.Tensor) -> torch.Tensor:
        # As a score sees it: where nothing measures, next to nothing.
        return 1 / LIMITED.smooth(Layout(place, radius, radius), [LENS] * 3, DEPTHS).square()

    assert gradcheck(seen, [position.requires_grad_()], rtol=1e-4)


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_the_type_is_that_of_the_layout(dtype):
    layout = standing([[0.0, 0.0], [20.0, 0.0]]).to(dtype)
    assert LIMITED.smooth(layout, [LENS] * 2, DEPTHS.to(dtype)).dtype == dtype
