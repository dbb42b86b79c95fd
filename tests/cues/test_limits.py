"""Limits of pairs: hand-worked depths, what the smooth factor promises, and what is refused."""

import math

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import grad, gradcheck

from multilens import Layout, Lens
from multilens.cues.limits import RAMP, PairLimits

WIDE = Lens(6.0, (0.5, 3.0), field_of_view_deg=90.0, near_focus=100.0)
TELE = Lens(12.0, (0.5, 3.0), field_of_view_deg=math.degrees(2 * math.atan(0.25)), near_focus=400.0)
UNKNOWN = Lens(6.0, (0.5, 3.0))

optional = st.none() | st.floats(1e-3, 10)
places = st.lists(st.tuples(st.floats(-100, 100), st.floats(-100, 100)), min_size=3, max_size=3)
lenses = st.builds(
    lambda f, fov, near: Lens(f, (0.5, 3.0), field_of_view_deg=fov, near_focus=near),
    st.floats(1, 30),
    st.none() | st.floats(5, 150),
    st.none() | st.floats(1, 1000),
)
DEPTHS = torch.logspace(1, 4, 200, dtype=torch.float64)


def apart(baseline: float) -> Layout:
    return Layout([[0.0, 0.0], [baseline, 0.0]], [1.0, 1.0], [500.0, 500.0])


def nearest(limits: PairLimits, baseline: float, *lenses: Lens) -> float:
    return limits.nearest(apart(baseline), lenses).item()


def test_the_disparity_limit_is_that_of_the_longer_lens():
    # 20 mm * 12 mm / 0.5 mm.
    assert nearest(PairLimits(0.5), 20.0, UNKNOWN, Lens(12.0, (0.5, 3.0))) == pytest.approx(480)


def test_equal_fields_need_room_to_overlap():
    # Half of a field of 90 degrees: 1 - b / (2 Z) = 1/2 at Z = b.
    assert nearest(PairLimits(least_overlap=0.5), 300.0, WIDE, WIDE) == pytest.approx(300)


def test_a_narrow_field_within_a_wide_one_needs_less():
    # t = 1 and 1/4: half of the narrower is seen by both up to b / Z = 1 + 1/4 - 1/4, so Z = 1000 for b = 1000.
    assert nearest(PairLimits(least_overlap=0.5), 1000.0, WIDE, TELE) == pytest.approx(1000)


def test_both_lenses_must_be_beyond_their_near_focus():
    assert nearest(PairLimits(), 10.0, WIDE, TELE) == 400.0


def test_what_is_unknown_limits_nothing():
    assert PairLimits().usable(apart(100.0), [UNKNOWN, UNKNOWN], DEPTHS).all()


def test_an_unknown_field_limits_no_known_one():
    narrow = Lens(6.0, (0.5, 3.0), field_of_view_deg=10.0)
    assert nearest(PairLimits(least_overlap=0.9), 100.0, narrow, UNKNOWN) == 0.0


def test_a_pair_is_usable_from_its_nearest_depth_on():
    depths = torch.tensor([479.0, 480.0, 481.0], dtype=torch.float64)
    mask = PairLimits(0.5).usable(apart(20.0), [Lens(12.0, (0.5, 3.0))] * 2, depths)
    assert mask.tolist() == [[False, True, True]]


@given(places, st.lists(lenses, min_size=3, max_size=3), optional, st.floats(0, 0.99))
def test_the_factor_is_zero_wherever_a_pair_may_not_be_used(position, given_lenses, disparity, overlap):
    limits, layout = PairLimits(disparity, overlap), Layout(position, [1.0] * 3, [500.0] * 3)
    factor = limits.factor(layout, given_lenses, DEPTHS)
    assert not factor[~limits.usable(layout, given_lenses, DEPTHS)].any()
    assert ((factor >= 0) & (factor <= 1)).all()


@given(places, st.lists(lenses, min_size=3, max_size=3), optional, st.floats(0, 0.99))
def test_the_factor_is_one_well_inside(position, given_lenses, disparity, overlap):
    limits, layout = PairLimits(disparity, overlap), Layout(position, [1.0] * 3, [500.0] * 3)
    beyond = limits.nearest(layout, given_lenses).unsqueeze(-1) * (1 + 1e-12) < DEPTHS * (1 - RAMP)
    assert (limits.factor(layout, given_lenses, DEPTHS)[beyond] == 1).all()


def test_the_near_focus_is_sharp():
    depths = torch.tensor([399.0, 400.0], dtype=torch.float64)
    assert PairLimits().factor(apart(10.0), [WIDE, TELE], depths).tolist() == [[0, 1]]


def test_the_factor_has_a_gradient_where_it_rises_and_none_elsewhere():
    position = torch.tensor([[0.0, 0.0], [20.0, 0.0]], dtype=torch.float64, requires_grad=True)
    layout = Layout(position, torch.ones(2).double(), torch.ones(2).double())
    # Usable from 240 mm on, wholly from 266.7 mm on.
    for depth, moves in ((200.0, False), (250.0, True), (300.0, False)):
        factor = PairLimits(0.5).factor(layout, [UNKNOWN] * 2, torch.tensor([depth], dtype=torch.float64))
        assert bool(grad(factor.sum(), position)[0].any()) is moves


def test_gradients():
    random = torch.Generator().manual_seed(0)
    position = (torch.rand(2, 3, 2, dtype=torch.float64, generator=random) * 80).requires_grad_()
    radius = torch.ones(2, 3, dtype=torch.float64)

    def factor(place: torch.Tensor) -> torch.Tensor:
        return PairLimits(0.6, 0.5).factor(Layout(place, radius, radius), [WIDE, WIDE, TELE], DEPTHS)

    assert gradcheck(factor, [position])


def test_coincident_lenses_have_a_finite_gradient():
    position = torch.zeros(2, 2, dtype=torch.float64, requires_grad=True)
    layout = Layout(position, torch.ones(2).double(), torch.ones(2).double())
    (slope,) = grad(PairLimits(0.5).factor(layout, [UNKNOWN] * 2, DEPTHS).sum(), position)
    assert slope.isfinite().all()


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_the_type_is_that_of_the_layout(dtype):
    assert PairLimits(0.5).factor(apart(20.0).to(dtype), [WIDE, TELE], DEPTHS.to(dtype)).dtype == dtype


def test_one_lens_has_no_pairs():
    one = Layout([[0.0, 0.0]], [1.0], [500.0])
    assert PairLimits(0.5).usable(one, [WIDE], DEPTHS).shape == (0, len(DEPTHS))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"max_disparity": 0.0}, "max_disparity must be > 0 mm and finite, got 0"),
        ({"max_disparity": math.inf}, "max_disparity must be > 0 mm and finite, got inf"),
        ({"least_overlap": 1.0}, "least_overlap must be >= 0 and < 1, got 1"),
        ({"least_overlap": -0.1}, "least_overlap must be >= 0 and < 1, got -0.1"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(arguments, message):
    with pytest.raises(ValueError, match=message):
        PairLimits(**arguments)
