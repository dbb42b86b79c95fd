"""What drifts, against cameras whose rays are followed."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import gradcheck

from multilens.optics.defocus import depth_to_differential_blur, differential_blur_to_depth
from multilens.optics.drift import (
    direction_drift,
    focus_drift_error,
    pair_drift_error,
    refocused,
    sensor_shift_to_vergence,
)
from multilens.optics.thin_lens import image_distance


def double(number: float) -> Tensor:
    return torch.tensor(number, dtype=torch.float64)


def image(point: Tensor, depth: Tensor, lens: Tensor, sensor: Tensor, f: float) -> Tensor:
    """Follow the ray from a point through the middle of a lens to a sensor f behind, to where it lands on it."""
    return lens + (lens - point) * f / depth - sensor


def triangulated(first: Tensor, second: Tensor, baseline: float, f: float) -> Tensor:
    return baseline * f / (second - first)


@pytest.mark.parametrize("depth", [300.0, 1000.0, 5000.0])
@pytest.mark.parametrize("point", [-80.0, 0.0, 40.0])
def test_a_camera_that_moved_and_a_lens_that_moved_over_its_sensor_mislead_a_pair_by_as_much(
    depth: float, point: float
):
    f, baseline, shift, decentre = 6.86, 20.0, 1e-4, 1e-6
    z, x = double(depth), double(point)
    still = image(x, z, double(baseline), double(baseline), f)
    zero = double(0.0)
    for moved, drift in (
        (image(x, z, double(shift), double(shift), f), direction_drift(z, double(f), double(shift), zero)),
        (image(x, z, double(decentre), zero, f), direction_drift(z, double(f), zero, double(decentre))),
    ):
        error = triangulated(moved, still, baseline, f) - z
        expected = pair_drift_error(z, double(baseline), drift, zero)
        # The next order of the expansion is smaller by the error over the depth.
        assert abs(error.item()) == pytest.approx(expected.item(), rel=2e-3)


def test_two_cameras_that_drift_apart_have_the_spread_of_many_such_pairs():
    generator = torch.Generator().manual_seed(0)
    f, baseline, depth = 6.0, 15.0, double(800.0)
    shift = 0.01 * torch.randn(2, 400_000, dtype=torch.float64, generator=generator)
    decentre = 1e-4 * torch.randn(2, 400_000, dtype=torch.float64, generator=generator)
    places = torch.tensor([[0.0], [baseline]], dtype=torch.float64)
    landed = image(double(5.0), depth, places + shift + decentre, places + shift, f) + shift
    # The sensors believe to stand where they were calibrated: their own shift is seen as a shift of the image.
    seen = landed - shift
    read = triangulated(seen[0], seen[1], baseline, f)
    drift = direction_drift(depth, double(f), double(0.01), double(1e-4))
    assert read.std().item() == pytest.approx(pair_drift_error(depth, double(baseline), drift, drift).item(), rel=5e-3)


def test_a_lens_over_its_sensor_counts_for_z_over_f_plus_one_cameras():
    z, f, zero = double(1000.0), double(5.0), double(0.0)
    alone, together = direction_drift(z, f, zero, double(1e-3)), direction_drift(z, f, double(1e-3), zero)
    assert (alone / together).item() == pytest.approx(201.0, rel=1e-12)


@given(focus=st.floats(100, 1e4), moved=st.floats(-1e-6, 1e-6))
def test_a_sensor_that_moved_is_in_focus_where_the_thin_lens_says(focus: float, moved: float):
    f = double(6.0)
    sensor = image_distance(f, double(focus))
    expected = image_distance(f, sensor + moved)  # the lens formula reads both ways
    vergence = sensor_shift_to_vergence(double(moved), sensor)
    assert refocused(double(focus), vergence).item() == pytest.approx(expected.item(), rel=1e-5)


def test_a_lens_that_drifts_beyond_infinity_is_focused_a_kilometre_away():
    assert refocused(double(2000.0), double(-0.001)).item() == pytest.approx(1e6)


def test_defocus_that_believes_a_wrong_focus_is_off_by_the_depth_squared_times_its_vergence():
    f, radius, focus, vergence, depth = double(6.0), double(2.0), double(900.0), double(1e-8), double(1500.0)
    blur = depth_to_differential_blur(depth, f, radius, refocused(focus, vergence))
    error = differential_blur_to_depth(blur, f, radius, focus) - depth
    assert abs(error.item()) == pytest.approx(focus_drift_error(depth, vergence).item(), rel=1e-4)


def test_gradients():
    inputs = [double(number).requires_grad_() for number in (700.0, 15.0, 6.0, 0.01, 0.002)]
    assert gradcheck(
        lambda z, b, f, s, e: pair_drift_error(z, b, direction_drift(z, f, s, e), direction_drift(z, f, e, s)), inputs
    )
    assert gradcheck(lambda z, d: refocused(z, d) + focus_drift_error(z, d), [inputs[0], double(1e-5).requires_grad_()])
