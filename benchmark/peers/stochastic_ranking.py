"""pymoo's improved stochastic ranking evolution strategy (ISRES), the best of its methods for one objective with constraints."""

import numpy as np
from pymoo.algorithms.soo.nonconvex.isres import ISRES
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize

from benchmark.found import Found, OutOfTimeError, Task
from benchmark.peers.priced import Priced


class _Question(PymooProblem):
    """One objective, one constraint."""

    def __init__(self, price: Priced) -> None:
        super().__init__(n_var=len(price.free), n_obj=1, n_ieq_constr=1, xl=0.0, xu=1.0)
        self.price = price

    def _evaluate(self, x: np.ndarray, out: dict, *_: object, **__: object) -> None:
        score, missing = self.price.score_and_missing(x)
        out["F"], out["G"] = score[:, None], missing[:, None] - 1e-12


def stochastic_ranking(task: Task) -> list[Found]:
    """Run with pymoo's default settings for the method until the clock stops."""
    price = Priced(task)
    try:
        while True:
            seed = int(price.random.integers(2**31))
            minimize(_Question(price), ISRES(sampling=price.starts(140)), ("n_gen", 10**6), seed=seed)
    except OutOfTimeError:
        return price.notebook.all()
