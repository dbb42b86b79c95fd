"""Amounts of what a design is given, and that more never hurts."""

import pytest
import torch
from shapely import MultiPolygon, box

import multilens as ml
from multilens.certificate import certify
from multilens.inverse.resource import BackSize, LensCount, WidestAperture


def question(back: ml.Back | None = None) -> ml.Problem:
    lens = ml.Lens(5.0, (0.5, 2.0), clearance=1.0)
    other = ml.Lens(8.0, (1.0, 3.0), clearance=1.0)
    default = ml.Back.rounded_rectangle(40, 30, 5).keep_out("flash", ml.disc((30.0, 8.0), 2.0), 0.5)
    return ml.Problem(back or default, [lens, other], ml.linear_depths(200, 900, 8))


def test_of_few_lenses_the_first_are_taken_and_of_many_the_last_is_repeated():
    problem = question()
    first, last = problem.lenses
    assert LensCount(problem).with_only(1).lenses == (first,)
    assert LensCount(problem).with_only(4).lenses == (first, last, last, last)


def test_a_size_is_told_by_what_the_outline_measures():
    assert BackSize(question(ml.Back.rectangle(40, 30))).words(0.5) == "0.5: 20 x 15 mm, 300 mm2"


def test_at_the_least_size_the_widest_lens_does_not_fit():
    resource = BackSize(question(ml.Back.rectangle(40, 30)))
    # Its body has a radius of 2 mm: it needs 4 of the 30 mm.
    assert resource.least == pytest.approx(4 / 30, rel=2e-3)
    assert resource.least < 4 / 30


def test_a_back_in_parts_has_no_smallest_size():
    parts = ml.Back(MultiPolygon([box(0, 0, 10, 10), box(20, 0, 30, 10)]))
    with pytest.raises(ValueError, match="outline must hold itself shrunk about its middle"):
        BackSize(question(parts))


def test_no_lens_opens_wider_than_the_widest_aperture_and_its_own():
    lenses = WidestAperture(question()).with_only(2.5).lenses
    assert [lens.aperture_radius for lens in lenses] == [(0.5, 2.0), (1.0, 2.5)]


def test_apertures_reach_from_what_no_lens_is_smaller_than_to_the_widest():
    resource = WidestAperture(question())
    assert (resource.least, resource.most) == (1.0, 3.0)


def test_an_aperture_of_lenses_of_one_focal_length_is_told_as_an_f_number():
    lens = ml.Lens(5.0, (0.5, 2.0))
    problem = ml.Problem(ml.Back.disc(20), [lens] * 2, [300.0])
    assert WidestAperture(problem).words(1.25) == "1.25 (f/2)"
    assert WidestAperture(question()).words(1.25) == "1.25"


def test_fixed_apertures_leave_nothing_to_choose():
    fixed = ml.Problem(ml.Back.disc(20), [ml.Lens(5.0, (1.0, 1.0))] * 2, [300.0])
    with pytest.raises(ValueError, match="lenses must have apertures to choose from"):
        WidestAperture(fixed)


@pytest.mark.parametrize("kind", [BackSize, WidestAperture])
def test_a_layout_that_fits_with_less_fits_with_more(kind):
    resource = kind(question())
    random = torch.Generator().manual_seed(3)
    amounts = torch.linspace(1.1, 3, 6).tolist() if kind is WidestAperture else torch.linspace(0.3, 1.5, 7).tolist()
    fitted = 0
    for _ in range(40):
        position = torch.rand(2, 2, generator=random, dtype=torch.float64) * torch.tensor([40.0, 30.0])
        radius = torch.tensor([0.5, 1.0]) + torch.rand(2, generator=random, dtype=torch.float64) * 1.5
        layout = ml.Layout(position, radius.double(), [500.0, 700.0])
        fits = []
        for amount in amounts:
            problem = resource.with_only(amount)
            certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
            fits.append(certificate.feasible)
        assert fits == sorted(fits)
        fitted += fits[-1]
    assert fitted > 5
