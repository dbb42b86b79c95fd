from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from benchmark.peers.model import MARGIN, Model
from benchmark.peers.slsqp import Slsqp
from benchmark.problems import CASES, Case
from multilens.search.legalise import legalise

STEP = 1e-8


def difference(function: Callable[[np.ndarray], Any], at: np.ndarray) -> np.ndarray:
    """Give the forward differences of a function along each unknown, the unknowns last."""
    return np.stack([(function(at + step) - function(at)) / STEP for step in STEP * np.eye(len(at))], axis=-1)


@pytest.fixture(params=CASES, ids=lambda case: case.name)
def solver(request: pytest.FixtureRequest) -> Slsqp:
    return Slsqp(Model(request.param.problem))


@pytest.fixture
def start(solver: Slsqp) -> np.ndarray:
    return solver.model.random_starts(np.random.default_rng(5), 1)[0]


def test_the_objective_is_the_logarithm_of_the_librarys_score(solver: Slsqp, start: np.ndarray) -> None:
    score = solver.model.problem.score(solver.model.layout(start)).item()
    assert solver.objective(start)[0] == pytest.approx(np.log(score), abs=1e-9)


def test_the_gradient_of_the_objective_is_that_of_finite_differences(solver: Slsqp, start: np.ndarray) -> None:
    gradient = solver.objective(start)[1]
    expected = difference(lambda v: solver.objective(v)[0], start)
    # A difference spans depths at which the winner changes: that is its error, not the gradient's.
    np.testing.assert_allclose(gradient, expected, atol=2e-3 * np.abs(gradient).max())


def test_the_gradients_of_the_room_are_those_of_finite_differences(solver: Slsqp, start: np.ndarray) -> None:
    np.testing.assert_allclose(solver.room_gradient(start), difference(solver.room, start), atol=1e-5)


def test_where_every_room_is_kept_the_exact_certificate_is_feasible(solver: Slsqp) -> None:
    model = solver.model
    for v in model.settle(model.random_starts(np.random.default_rng(6), 16))[0]:
        exact = legalise(model.problem, model.layout(v))[1].feasible
        if solver.room(v).min() >= 0:
            assert exact
        elif solver.room(v).min() * model.size.max() < -1e-3:
            assert not exact


@pytest.mark.parametrize("case", [case for case in CASES if len(case.problem.lenses) <= 4], ids=lambda case: case.name)
def test_a_run_ends_feasible_and_no_worse(case: Case) -> None:
    model = Model(case.problem)
    (start,) = model.random_starts(np.random.default_rng(7), 1)
    settled, missing = model.settle(Slsqp(model).run(start)[None])
    begun, lacking = model.settle(start[None])
    assert missing[0] < MARGIN
    assert model.score(settled)[0] <= model.score(begun)[0] or lacking[0] > 0
