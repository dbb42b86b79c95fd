import pytest
import torch

import multilens as ml
from multilens.search.exchanged import exchanged
from multilens.search.limits import Limits

WIDE, NARROW = ml.Lens(1.0, (1.0, 12.0)), ml.Lens(1.0, (1.0, 4.0), clearance=2.0)
PLACES, RADII, FOCI = [(-12.0, 0.0), (6.0, 3.0), (8.0, -15.0)], [10.0, 4.0, 3.0], [[20.0], [30.0], [40.0]]


def problem(*lenses: ml.Lens) -> ml.Problem:
    return ml.Problem(ml.Back.disc(25), lenses, ml.linear_depths(20, 50, 16), gap=0.5)


def test_two_unlike_lenses_change_places_and_take_the_room_of_the_other() -> None:
    both = exchanged(problem(WIDE, NARROW, NARROW), ml.Layout(PLACES, RADII, FOCI))
    a, b, c = PLACES
    assert [[tuple(place) for place in row] for row in both.position.tolist()] == [[b, a, c], [c, b, a]]
    assert both.aperture_radius.tolist() == [[6, 4, 3], [5, 4, 4]]


def test_foci_stay_with_their_lenses() -> None:
    both = exchanged(problem(WIDE, NARROW, NARROW), ml.Layout(PLACES, RADII, FOCI))
    assert both.focus.tolist() == [FOCI, FOCI]


def test_lenses_that_are_alike_are_not_exchanged() -> None:
    assert len(exchanged(problem(NARROW, NARROW, NARROW), ml.Layout(PLACES, RADII, FOCI)).position) == 0


def test_a_lens_does_not_go_where_its_smallest_body_is_too_large() -> None:
    fixed = ml.Lens(1.0, (10.0, 10.0))
    assert len(exchanged(problem(fixed, NARROW, NARROW), ml.Layout(PLACES, RADII, FOCI)).position) == 0


@pytest.mark.parametrize("seed", range(4))
def test_what_was_feasible_stays_feasible(seed: int) -> None:
    question, generator = (
        problem(WIDE, NARROW, ml.Lens(1.0, (0.5, 3.0), clearance=1.0)),
        torch.Generator().manual_seed(seed),
    )
    radius = torch.tensor([1.0, 1.0, 0.5]) + 2 * torch.rand(3, generator=generator)
    layout = ml.Layout(torch.tensor(PLACES, dtype=torch.float64), radius.double(), FOCI)
    assert Limits(question)(layout).least >= 0
    assert (Limits(question)(exchanged(question, layout)).least >= -1e-9).all()
