"""The methods that are compared, by name; each is loaded when first used: one that is not installed is a failure in the table."""

from importlib import import_module
from time import monotonic

import multilens as ml
from benchmark.found import Found, Method, Notebook, Task
from multilens.search.progress import Progress

PEERS = {
    "SLSQP": "slsqp.slsqp",
    "differential evolution": "evolution.evolution",
    "CMA-ES": "cma_es.cma_es",
    "genetic algorithm": "genetic.genetic",
    "random search": "random_search.random_search",
}
"""Module and function of each."""

OURS, RIVAL = "multilens", "SLSQP"


def method(name: str) -> Method:
    """Give a method.

    Raises:
        ImportError: it needs a library that is not installed.
    """
    if name == OURS:
        return multilens
    module, function = PEERS[name].split(".")
    return getattr(import_module(f"benchmark.peers.{module}"), function)


def multilens(task: Task) -> list[Found]:
    """Run the search with its default settings, without its proof; what it had on the way is what its listener was told."""
    notebook = Notebook(task, monotonic)

    def listen(progress: Progress) -> None:
        layout = progress.layout
        if layout is not None:
            notebook.tell(progress.best, lambda: layout)

    design = ml.solve(task.problem, seed=task.seed, time_limit=task.limit, proof=0, listener=listen)
    if design.feasible:
        notebook.tell(design.score, lambda: design.layout)
    return notebook.all()
