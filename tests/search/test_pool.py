from math import isnan

import pytest
import torch

import multilens as ml
from multilens.search.pool import Candidate, Elite


def claimed(*discs: tuple[float, float, float]) -> Candidate:
    lenses = [ml.Lens(1.0, (0.1, 3.0))] * len(discs)
    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), lenses, lambda layout: -layout.aperture_radius)
    layout = ml.Layout([[x, y] for x, y, _ in discs], [radius for *_, radius in discs], [1.0] * len(discs))
    return Candidate.of(problem, layout)


LARGE, SMALL = claimed((5.0, 5.0, 3.0)), claimed((5.0, 5.0, 2.0))
FAR_OUT, OUT = claimed((1.0, 5.0, 3.0)), claimed((2.0, 5.0, 3.0))


def test_a_candidate_has_the_score_of_its_layout() -> None:
    assert LARGE.score == -3.0


def test_an_infeasible_candidate_has_no_score() -> None:
    assert isnan(OUT.score)
    assert not OUT.certificate.feasible


@pytest.mark.parametrize(
    ("better", "worse"),
    [(LARGE, SMALL), (SMALL, OUT), (OUT, FAR_OUT), (OUT, None)],
    ids=["by score", "feasible", "by what is lacking", "than none"],
)
def test_one_is_better(better: Candidate, worse: Candidate | None) -> None:
    assert better.better_than(worse)


@pytest.mark.parametrize(("worse", "better"), [(SMALL, LARGE), (OUT, SMALL), (FAR_OUT, OUT), (LARGE, LARGE)], ids=str)
def test_the_other_is_not(worse: Candidate, better: Candidate) -> None:
    assert not worse.better_than(better)


def vectors(*values: float) -> tuple[torch.Tensor, torch.Tensor]:
    value = torch.tensor(values, dtype=torch.float64)
    return value.unsqueeze(-1).expand(-1, 3), value


def test_the_best_are_kept_in_order() -> None:
    elite = Elite(3)
    elite.add(*vectors(5.0, 2.0, 4.0, 1.0))
    assert elite.value.tolist() == [1.0, 2.0, 4.0]
    assert elite.share[:, 0].tolist() == [1.0, 2.0, 4.0]


def test_later_ones_take_the_places_of_worse_ones() -> None:
    elite = Elite(2)
    elite.add(*vectors(5.0, 3.0))
    elite.add(*vectors(4.0, 6.0))
    assert elite.value.tolist() == [3.0, 4.0]


def test_of_those_alike_one_is_kept() -> None:
    elite = Elite(4)
    elite.add(*vectors(1.0, 1.0 + 1e-7, 2.0))
    assert elite.value.tolist() == [1.0, 2.0]


def test_what_is_no_number_is_not_kept() -> None:
    elite = Elite(4)
    elite.add(*vectors(float("inf"), 1.0, float("nan")))
    assert elite.value.tolist() == [1.0]


def test_an_elite_may_stay_empty() -> None:
    elite = Elite(4)
    elite.add(*vectors(float("inf")))
    elite.add(*vectors(float("nan")))
    assert len(elite.value) == 0
