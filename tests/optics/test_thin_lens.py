"""The thin lens against the Gaussian formula, ray geometry and the definition of the f-number."""

import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens.optics.thin_lens import circle_of_confusion, f_number, image_distance

ROUNDING = 1e-12
"""Relative; a few dozen roundings of double precision."""

focal_lengths = st.floats(1.0, 100.0)
radii = st.floats(0.1, 50.0)
depths = st.floats(150.0, 1e5)


def double(*numbers: float) -> list[torch.Tensor]:
    return [torch.tensor(number, dtype=torch.float64) for number in numbers]


def test_f_number_is_marked_on_a_fifty_millimetre_lens():
    # 50 mm f/2 has an entrance pupil of 25 mm across.
    assert f_number(*double(50.0, 12.5)) == 2.0


@given(focal_lengths, depths)
def test_image_distance_satisfies_the_gaussian_formula(focal_length, depth):
    f, z = double(focal_length, depth)
    v = image_distance(f, z)
    torch.testing.assert_close(1 / z + 1 / v, 1 / f, rtol=ROUNDING, atol=0)


def test_at_twice_the_focal_length_the_image_is_as_far_as_the_object():
    assert image_distance(*double(6.0, 12.0)) == 12.0


def test_a_far_object_is_imaged_at_the_focal_length():
    torch.testing.assert_close(image_distance(*double(6.0, 1e12)), *double(6.0), rtol=1e-11, atol=0)


@given(focal_lengths, radii, depths, depths)
def test_circle_of_confusion_is_the_width_of_the_ray_cone_at_the_sensor(focal_length, radius, focus, depth):
    f, a, zf, z = double(focal_length, radius, focus, depth)
    sensor, image = image_distance(f, zf), image_distance(f, z)
    # The rays through the rim of the aperture meet at the image and are |sensor - image| / image of its diameter apart here.
    cone = 2 * a * (sensor - image) / image
    # The two image distances differ little: what they lose by cancellation is allowed for.
    torch.testing.assert_close(circle_of_confusion(f, a, zf, z), cone, rtol=1e-9, atol=2e-14 * radius)


def test_a_point_in_focus_is_sharp():
    assert circle_of_confusion(*double(6.0, 1.5, 800.0, 800.0)) == 0


def test_blur_is_positive_beyond_focus_and_negative_before():
    f, a, zf = double(6.0, 1.5, 800.0)
    beyond, before = circle_of_confusion(f, a, zf, zf + 1), circle_of_confusion(f, a, zf, zf - 1)
    assert beyond > 0 > before


def test_gradients():
    arguments = [x.requires_grad_() for x in double(6.0, 1.5, 800.0, 500.0)]
    assert gradcheck(circle_of_confusion, arguments)
    assert gradcheck(image_distance, (arguments[0], arguments[3]))
    assert gradcheck(f_number, arguments[:2])


def test_arguments_broadcast_and_keep_their_type():
    blur = circle_of_confusion(torch.tensor(6.0), torch.rand(3, 1), torch.tensor(800.0), torch.linspace(200, 900, 5))
    assert blur.shape == (3, 5)
    assert blur.dtype == torch.float32
