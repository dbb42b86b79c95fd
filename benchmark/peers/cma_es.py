"""pycma: CMA-ES with restarts of large and small populations in turn (BIPOP)."""

import cma
import numpy as np

from benchmark.found import Found, OverError, Task
from benchmark.peers.priced import Priced

FIRST_STEP = 0.2
"""Standard deviation of the first population, as a part of the range of each unknown."""


def cma_es(task: Task) -> list[Found]:
    """Restart until the clock stops."""
    price = Priced(task)
    options = {"bounds": [0, 1], "verbose": -9, "seed": task.seed + 1, "tolfun": 1e-9, "maxfevals": float("inf")}
    try:
        while True:
            cma.fmin2(
                None,
                lambda: price.starts(1)[0],
                FIRST_STEP,
                options,
                restarts=9,
                bipop=True,
                parallel_objective=lambda x, *_: price(np.asarray(x)).tolist(),
            )
    except OverError:
        return price.notebook.all()
