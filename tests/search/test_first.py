from dataclasses import replace
from math import inf
from time import monotonic

import pytest
import torch

import multilens as ml
from multilens.search.first import MOST_LENSES, first_layouts
from multilens.search.foci import Foci
from multilens.search.limits import Limits
from multilens.search.polish import OutOfTimeError
from multilens.search.starts import tried_places
from multilens.search.variables import Variables

EYE = ml.Lens(1.0, (1.0, 24.0))
CAMERA = ml.Lens(6.86, (0.31, 1.93), (200.0, 5000.0), 6.17, 2.44e-4, 2.44e-4)


def chosen(problem: ml.Problem, generator: torch.Generator, deadline: float = inf) -> list[ml.Layout]:
    variables = Variables(problem)
    foci, tried = Foci(problem, variables, generator), tried_places(problem.back, 0)
    found = first_layouts(problem, variables, foci, Limits(problem), tried, generator, deadline)
    return [variables.layout_of(share) for share, _ in found]


def cameras() -> ml.Problem:
    return ml.Problem(ml.Back.rectangle(70, 150), [CAMERA] * 4, ml.log_depths(200, 5000, 256))


def eyes(count: int) -> ml.Problem:
    return ml.Problem(ml.Back.disc(25), [EYE] * count, ml.linear_depths(20, 50, 64))


def test_where_there_is_room_for_the_widest_apertures_the_sketch_is_as_good_as_can_be(
    generator: torch.Generator,
) -> None:
    problem = cameras()
    (layout,) = chosen(problem, generator)
    bound = ml.lower_bound(problem)
    # What the bound leaves open is 0.1 % here.
    assert problem.score(layout).item() < 1.002 * bound.value


def test_crowded_lenses_come_to_local_optima(generator: torch.Generator) -> None:
    problem = eyes(2)
    found = chosen(problem, generator)
    best = ml.solve(problem, starts=16, patience=4, proof=0)
    # They are polished as if depths had no gaps, to 1e-5.
    assert min(problem.score(layout).item() for layout in found) < 1.01 * best.score


def test_what_is_chosen_is_feasible(generator: torch.Generator) -> None:
    for problem in (cameras(), eyes(2), eyes(3)):
        for layout in chosen(problem, generator):
            assert Limits(problem)(layout).least > -1e-9


def test_of_many_crowded_lenses_nothing_is_chosen(generator: torch.Generator) -> None:
    assert chosen(eyes(MOST_LENSES + 1), generator) == []


@pytest.mark.parametrize(
    "problem",
    [
        ml.Problem(ml.Back.disc(25), [EYE, replace(EYE, position=(0.0, 0.0))], [20.0, 50.0]),
        ml.Problem(ml.Back.disc(25), [EYE] * 2, [20.0, 50.0], metric=ml.WorstCase()),
    ],
    ids=["a lens has its place", "no closed form"],
)
def test_nothing_is_chosen_where_too_little_is_known(problem: ml.Problem, generator: torch.Generator) -> None:
    assert chosen(problem, generator) == []


def test_it_keeps_the_deadline(generator: torch.Generator) -> None:
    with pytest.raises(OutOfTimeError):
        chosen(eyes(2), generator, monotonic() - 1)
