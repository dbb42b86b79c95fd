"""Defocus against its inverses, its own derivatives, and stereo in the limit where the two agree."""

import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import grad, gradcheck

from multilens.optics.defocus import (
    blur_to_depth,
    defocus_band,
    defocus_sensitivity,
    depth_to_differential_blur,
    differential_blur_to_depth,
    focused_sensitivity,
)
from multilens.optics.stereo import stereo_sensitivity
from multilens.optics.thin_lens import circle_of_confusion, f_number, image_distance

ROUNDING = 1e-12
"""Relative; a few dozen roundings of double precision."""

focal_lengths = st.floats(2.0, 50.0)
radii = st.floats(0.1, 25.0)
depths = st.floats(100.0, 1e4)


def double(*numbers: float) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


@given(focal_lengths, radii, depths, depths)
def test_blur_of_a_thin_lens_leads_back_to_the_depth(focal_length, radius, focus, depth):
    f, a, zf, z = double(focal_length, radius, focus, depth)
    blur = circle_of_confusion(f, a, zf, z)
    found = blur_to_depth(blur, f, image_distance(f, zf), f_number(f, a))
    # v0 - f cancels to f^2 / Z, of v0: the digits lost are those of Z / f, at most 1e4 / 2.
    torch.testing.assert_close(found, z, rtol=1e-10, atol=0)


@given(focal_lengths, radii, depths, depths)
def test_differential_blur_leads_back_to_the_depth(focal_length, radius, focus, depth):
    f, a, zf, z = double(focal_length, radius, focus, depth)
    found = differential_blur_to_depth(depth_to_differential_blur(z, f, a, zf), f, a, zf)
    torch.testing.assert_close(found, z, rtol=ROUNDING * 100, atol=0)


@given(focal_lengths, radii, depths, depths)
def test_defocus_sensitivity_is_the_derivative_of_the_depth(focal_length, radius, focus, depth):
    f, a, zf, z = double(focal_length, radius, focus, depth)
    blur = depth_to_differential_blur(z, f, a, zf).requires_grad_()
    (slope,) = grad(differential_blur_to_depth(blur, f, a, zf), blur)
    torch.testing.assert_close(defocus_sensitivity(z, a, f), slope.abs(), rtol=ROUNDING * 1000, atol=0)


def test_differential_blur_is_zero_in_focus():
    assert depth_to_differential_blur(*double(800.0, 6.0, 1.5, 800.0)) == 0


def test_differential_blur_is_positive_nearer_than_focus():
    near, far = depth_to_differential_blur(torch.tensor([700.0, 900.0]), *double(6.0, 1.5, 800.0))
    assert near > 0 > far


@given(focal_lengths, radii, depths, depths)
def test_differential_blur_is_half_the_circle_of_confusion_with_the_sensor_at_the_focal_length(f, a, zf, z):
    # Far objects: the sensor stands at the focal length, and radius and diameter, near and far, differ as stated.
    focal, radius, focus, depth = double(f, a, zf, z)
    diameter = circle_of_confusion(focal, radius, focus, depth) * focal / image_distance(focal, focus)
    blur = depth_to_differential_blur(depth, focal, radius, focus)
    torch.testing.assert_close(2 * blur, -diameter, rtol=1e-9, atol=1e-15 * f * a)


@given(focal_lengths, radii, depths)
def test_defocus_is_stereo_with_the_aperture_for_a_baseline(focal_length, radius, depth):
    f, a, z = double(focal_length, radius, depth)
    torch.testing.assert_close(defocus_sensitivity(z, a, f), stereo_sensitivity(z, a, f), rtol=ROUNDING, atol=0)


@given(focal_lengths, radii, depths)
def test_as_the_focus_comes_to_the_lens_defocus_becomes_stereo_across_the_aperture(focal_length, radius, depth):
    f, a, z = double(focal_length, radius, depth)
    nearly = focused_sensitivity(z, a, f, z * 1e-9)
    torch.testing.assert_close(nearly, stereo_sensitivity(z, 2 * a, f), rtol=2e-9, atol=0)


def test_focused_sensitivity_is_zero_in_focus():
    assert focused_sensitivity(*double(800.0, 1.5, 6.0, 800.0)) == 0


@given(focal_lengths, radii, depths, st.floats(0.01, 0.99))
def test_defocus_beats_stereo_inside_its_band_only(focal_length, radius, focus, inside):
    f, a, zf = double(focal_length, radius, focus)
    b = a * 5
    near, far = defocus_band(zf, a, b)
    assert near < zf < far

    def wins(z: torch.Tensor) -> bool:
        return bool(focused_sensitivity(z, a, f, zf) < stereo_sensitivity(z, b, f))

    assert wins(near + inside * (far - near))
    assert not wins(near * (1 - inside * 0.5))
    assert not wins(far * (1 + inside))


@given(radii, depths, st.floats(1.01, 100.0))
def test_at_the_ends_of_the_band_the_cues_are_equal(radius, focus, ratio):
    (a, zf), f = double(radius, focus), double(6.0)[0]
    b = 2 * a * ratio
    for z in defocus_band(zf, a, b):
        cues = focused_sensitivity(z, a, f, zf), stereo_sensitivity(z, b, f)
        # |Z - Zf| is Z / ratio at the ends: no more than two of the digits cancel.
        torch.testing.assert_close(*cues, rtol=1e-10, atol=0)


def test_gradients():
    z, f, a, zf, b = (x.requires_grad_() for x in double(500.0, 6.0, 1.5, 800.0, 20.0))
    blur, sensor, number = (x.requires_grad_() for x in double(0.01, 6.05, 2.0))
    assert gradcheck(blur_to_depth, (blur, f, sensor, number))
    assert gradcheck(differential_blur_to_depth, (blur, f, a, zf))
    assert gradcheck(depth_to_differential_blur, (z, f, a, zf))
    assert gradcheck(defocus_sensitivity, (z, a, f))
    assert gradcheck(focused_sensitivity, (z, a, f, zf))
    assert gradcheck(defocus_band, (zf, a, b))


def test_arguments_broadcast_and_keep_their_type():
    error = focused_sensitivity(torch.linspace(200, 900, 5), torch.rand(3, 1), torch.tensor(6.0), torch.tensor(800.0))
    assert error.shape == (3, 5)
    assert error.dtype == torch.float32
