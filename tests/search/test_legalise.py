import pytest
import torch

import multilens as ml
from multilens.search.legalise import legalise


def square(count: int) -> ml.ScoreProblem:
    return ml.ScoreProblem(
        ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.1, 3.0))] * count, lambda layout: -layout.aperture_radius
    )


def test_what_lacks_a_hair_of_room_is_made_feasible() -> None:
    # Two discs of radius 2.5 touch; given 3e-10 mm too much they overlap by twice that.
    layout = ml.Layout([[2.5, 2.5], [7.5, 2.5]], [2.5 + 3e-10, 2.5 + 3e-10], [1.0, 1.0])
    legal, certificate = legalise(square(2), layout)
    assert certificate.feasible
    assert (layout.aperture_radius - legal.aperture_radius).max() < 2e-9


def test_what_is_feasible_is_only_rounded() -> None:
    layout = ml.Layout([[3.0, 1 / 3], [7.0, 5.0]], [0.25, 0.5], [1.0, 1.0])
    legal, certificate = legalise(square(2), layout)
    assert certificate.feasible
    assert legal.position[0, 1].item() == 0.333333333333
    assert torch.equal(legal.aperture_radius, layout.aperture_radius)


def test_bounds_and_locks_are_met_to_the_bit() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10),
        [ml.Lens(1.0, (0.1, 0.7), position=(1.1, 2.3))],
        lambda layout: -layout.aperture_radius,
    )
    legal, certificate = legalise(problem, ml.Layout([[1.1000000001, 2.3]], [0.7000000001], [1.0]))
    assert legal.position.tolist() == [[1.1, 2.3]]
    assert legal.aperture_radius.tolist() == [0.7]
    assert certificate.feasible


def test_what_lacks_more_is_told() -> None:
    layout = ml.Layout([[2.5, 2.5], [7.0, 2.5]], [2.5, 2.5], [1.0, 1.0])
    _, certificate = legalise(square(2), layout)
    assert certificate.tightest.what == "lens 1 to lens 2"
    assert certificate.tightest.room == pytest.approx(-0.5, abs=1e-6)
