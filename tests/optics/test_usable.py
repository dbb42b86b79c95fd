"""Limits of a pair against rays counted one by one, similar triangles and published cameras."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens.optics.usable import disparity_parallax, field_overlap, nearest_depth, overlap_parallax


def scalar(number: float) -> torch.Tensor:
    return torch.tensor(number, dtype=torch.float64)


def counted_overlap(depth: float, baseline: float, first: float, second: float, rays: int = 100_001) -> float:
    """Part of the points across the narrower field, in equal steps, that the other lens sees too."""
    narrow, wide = min(first, second), max(first, second)
    points = torch.linspace(-depth * narrow, depth * narrow, rays, dtype=torch.float64)
    return ((points - baseline).abs() <= depth * wide).double().mean().item()


@given(st.floats(10, 1e4), st.floats(0, 200), st.floats(0.1, 3), st.floats(0.1, 3))
def test_the_overlap_is_the_share_of_points_that_both_see(depth, baseline, first, second):
    overlap = field_overlap(*(scalar(number) for number in (depth, baseline, first, second))).item()
    # A ray more or less at each end.
    assert overlap == pytest.approx(counted_overlap(depth, baseline, first, second), abs=3e-5)


def test_equal_fields_overlap_by_one_less_the_baseline_over_the_width():
    # A field of 90 degrees is 200 mm wide at 100 mm: a baseline of 50 mm leaves three quarters.
    assert field_overlap(scalar(100.0), scalar(50.0), scalar(1.0), scalar(1.0)).item() == pytest.approx(0.75)


def test_a_narrow_field_may_lie_wholly_within_a_wide_one():
    assert field_overlap(scalar(100.0), scalar(49.0), scalar(1.0), scalar(0.5)).item() == 1.0


@given(st.floats(0.1, 3), st.floats(0.1, 3), st.floats(0.01, 0.99))
def test_at_the_largest_parallax_the_overlap_is_the_least(first, second, least):
    largest = overlap_parallax(scalar(first), scalar(second), least)
    overlap = field_overlap(scalar(100.0), 100 * largest, scalar(first), scalar(second)).item()
    assert overlap == pytest.approx(least, abs=1e-12)


def test_the_disparity_of_the_longer_lens_is_at_its_limit():
    parallax = disparity_parallax(scalar(4.0), scalar(10.0), 0.5).item()
    # Shifts on the two sensors: 0.2 and 0.5 mm.
    assert (4.0 * parallax, 10.0 * parallax) == pytest.approx((0.2, 0.5))


def test_a_published_camera_is_near_where_it_is_published():
    # Luxonis OAK-D: 882.5 pixels of focal length, 75 mm baseline; a search of 95 pixels reaches to 69.7 cm.
    parallax = disparity_parallax(scalar(882.5), scalar(882.5), 95.0)
    assert nearest_depth(scalar(75.0), parallax, scalar(0.0)).item() == pytest.approx(697, abs=0.5)


def test_without_a_limit_of_parallax_the_near_focus_is_what_is_left():
    assert nearest_depth(scalar(75.0), scalar(torch.inf), scalar(200.0)).item() == 200.0


def test_gradients():
    baseline = scalar(90.0).requires_grad_()
    assert gradcheck(lambda b: nearest_depth(b, scalar(0.1), scalar(200.0)), [baseline])
    assert gradcheck(lambda b: field_overlap(scalar(300.0), b, scalar(0.7), scalar(0.6)), [baseline])
