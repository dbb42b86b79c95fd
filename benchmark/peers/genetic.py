"""pymoo's genetic algorithm, which did best of its methods for one objective under constraints."""

from contextlib import suppress

import numpy as np
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize

from benchmark.found import Found, OverError, Task
from benchmark.peers.priced import Priced

POPULATION = 60


class _Question(PymooProblem):
    """One objective, one constraint."""

    def __init__(self, price: Priced) -> None:
        super().__init__(n_var=len(price.free), n_obj=1, n_ieq_constr=1, xl=0.0, xu=1.0)
        self.price = price

    def _evaluate(self, x: np.ndarray, out: dict, *_: object, **__: object) -> None:
        score, missing = self.price.score_and_missing(x)
        out["F"], out["G"] = score[:, None], missing[:, None] - 1e-12


def genetic(task: Task) -> list[Found]:
    """Let one population breed until the clock stops."""
    price = Priced(task)
    seed = int(price.random.integers(2**31))
    # pymoo takes an array for its first population, as its documentation says; the types that are inferred do not.
    method = GA(POPULATION, sampling=price.starts(POPULATION))  # pyright: ignore[reportArgumentType]
    with suppress(OverError):
        minimize(_Question(price), method, ("n_gen", 10**9), seed=seed)
    return price.notebook.all()
