"""Lenses: the range of each number, and apertures by f-number."""

from math import inf, nan

import pytest

from multilens import Lens
from multilens.lens import telling_names


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("focal_length", 0.0, "focal_length must be > 0 and finite, got 0"),
        ("focal_length", nan, "focal_length must be > 0 and finite, got nan"),
        ("aperture_radius", (0.0, 1.0), "least aperture_radius must be > 0 and finite, got 0"),
        ("aperture_radius", (1.0, inf), "largest aperture_radius must be > 0 and finite, got inf"),
        ("aperture_radius", (2.0, 1.0), "aperture_radius must have least <= largest, got 2 > 1"),
        ("focus", (200.0, 100.0), "focus must have least <= largest, got 200 > 100"),
        ("clearance", -1.0, "clearance must be >= 0 mm and finite, got -1"),
        ("disparity_noise", 1e-300, "disparity_noise must be from 1e-20 to 1e[+]20, got 1e-300"),
        ("disparity_noise", 0.0, "disparity_noise must be > 0 and finite, got 0"),
        ("blur_noise", -1.0, "blur_noise must be > 0 and finite, got -1"),
        ("tiers", 0, "tiers must be a whole number >= 1, got 0"),
        ("position", (1.0, nan), "y of position must be finite, got nan"),
        ("field_of_view_deg", 180.0, "field_of_view_deg must be > 0 and < 180 degrees, got 180"),
        ("field_of_view_deg", nan, "field_of_view_deg must be > 0 and < 180 degrees, got nan"),
        ("near_focus", 0.0, "near_focus must be > 0 and finite, got 0"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(key, value, message):
    arguments = {"focal_length": 6.0, "aperture_radius": (0.5, 2.0)} | {key: value}
    with pytest.raises(ValueError, match=message):
        Lens(**arguments)


def test_a_lens_focuses_no_nearer_than_it_can():
    with pytest.raises(ValueError, match="near_focus must be <= the nearest focus = 200 mm, got 300"):
        Lens(6.0, (0.5, 2.0), focus=(200.0, 1000.0), near_focus=300.0)


def test_a_lens_may_be_fixed_in_one_coordinate():
    assert Lens(6.0, (0.5, 2.0), position=(None, 3.0)).position == (None, 3.0)


def test_f_numbers_bound_the_aperture():
    # A 24 mm lens at f/2 opens 12 mm wide, at f/8 3 mm.
    assert Lens.from_f_number(24.0, (2.0, 8.0)).aperture_radius == (1.5, 6.0)


def test_f_numbers_out_of_order_are_refused_by_name():
    with pytest.raises(ValueError, match="f_number must have least <= largest, got 8 > 2"):
        Lens.from_f_number(24.0, (8.0, 2.0))


def test_a_lens_by_f_number_takes_everything_else_too():
    assert Lens.from_f_number(24.0, (2.0, 8.0), tiers=3).tiers == 3


def test_least_body_is_the_smallest_aperture_and_the_clearance():
    assert Lens(6.0, (0.5, 2.0), clearance=1.25).least_body_radius == 1.75


def test_a_name_makes_no_lens_unlike_another():
    assert Lens(6.0, (0.5, 2.0), name="main") == Lens(6.0, (0.5, 2.0), name="tele")


@pytest.mark.parametrize("name", ["", " ", "two\nlines", "x" * 41])
def test_a_name_that_cannot_stand_in_a_table_is_refused(name):
    with pytest.raises(ValueError, match="name must be a line of at most 40 letters"):
        Lens(6.0, (0.5, 2.0), name=name)


@pytest.mark.parametrize(
    ("names", "told"),
    [(("main", "tele"), ("main", "tele")), ((None, "tele"), ("", "tele")), (("main", "main"), ()), ((None, None), ())],
)
def test_names_are_told_where_they_tell_one_lens_from_another(names, told):
    assert telling_names([Lens(6.0, (0.5, 2.0), name=name) for name in names]) == told
