"""SciPy's differential evolution, a whole population at a time."""

import numpy as np
from scipy.optimize import differential_evolution

from benchmark.found import Found, OverError, Task
from benchmark.peers.priced import Priced

POPULATION = 2
"""Vectors for each unknown: few, so that there are many generations; SciPy's 15 hardly moved in the time there is."""


def evolution(task: Task) -> list[Found]:
    """Evolve one population after the other, the next when one has come together, until the clock stops."""
    price = Priced(task)
    unknowns = len(price.free)
    try:
        while True:
            differential_evolution(
                lambda x: price(np.atleast_2d(x.T)),
                [(0.0, 1.0)] * unknowns,
                # SciPy takes an array here, as its documentation says; the types of its stubs do not.
                init=price.starts(POPULATION * unknowns),  # pyright: ignore[reportArgumentType]
                strategy="best1bin",
                mutation=(0.4, 0.9),
                recombination=0.8,
                maxiter=10**6,
                tol=1e-6,
                polish=False,
                vectorized=True,
                updating="deferred",
                rng=price.random,
            )
    except OverError:
        return price.notebook.all()
