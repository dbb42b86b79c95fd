from time import monotonic

import numpy as np
import pytest

from benchmark.found import OverError, Task
from benchmark.methods import PEERS, method
from benchmark.peers.priced import Priced
from benchmark.problems import CASES
from benchmark.referee import judge

NEEDED = {"CMA-ES": "cma", "genetic algorithm": "pymoo"}

PROBLEM = next(case for case in CASES if case.name == "2 disc").problem


def test_a_feasible_vector_costs_the_logarithm_of_its_score() -> None:
    price = Priced(Task(PROBLEM, 0, monotonic(), 60.0))
    # Two small lenses far apart.
    x = price.model.join(np.array([[[-15.0, 0.0], [15.0, 0.0]]]), np.full((1, 2), 5.0), np.full((1, 2), 30.0))
    score = PROBLEM.score(price.model.layout(x[0])).item()
    assert price(x)[0] == pytest.approx(np.log(score), abs=1e-9)


def test_missing_room_costs() -> None:
    price = Priced(Task(PROBLEM, 0, monotonic(), 60.0))
    x = price.model.join(np.array([[[-25.0, -25.0], [15.0, 0.0]]]), np.full((1, 2), 5.0), np.full((1, 2), 30.0))
    assert price.score_and_missing(x)[1][0] > 0.1


def test_after_the_end_nothing_is_priced() -> None:
    price = Priced(Task(PROBLEM, 0, monotonic() - 1, 0.5))
    with pytest.raises(OverError):
        price(price.starts(1))


@pytest.mark.parametrize("name", PEERS)
def test_a_method_finds_something_that_the_referee_lets_count(name: str) -> None:
    if name in NEEDED:
        pytest.importorskip(NEEDED[name], reason="needs the extra bench")
    found = method(name)(Task(PROBLEM, 0, monotonic(), 0.4))
    judged = judge(PROBLEM, found)
    assert judged
    assert judged[-1].score == pytest.approx(found[-1].score, rel=1e-6)
