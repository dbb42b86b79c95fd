"""A problem as optimisers without gradients see it: one number for each of many vectors, missing room priced in."""

from time import monotonic

import numpy as np
from jaxtyping import Float

from benchmark.found import Notebook, Task
from benchmark.peers.model import Model

PRICE = 100.0
"""Of missing room as a part of the back's longer side, in the logarithm of the score: 1 % missing costs a factor of e."""

ROUNDING = 1e-9
"""mm; room that may be missing in a layout that is told, less than the margin."""


class Priced:
    """Prices vectors of what is free, after radii have given way to what is in their way, and tells the feasible ones.

    Giving way makes nearly every vector feasible whose centres are: differential evolution and CMA-ES did better so than by the
    price alone, random search alike.

    Args:
        task: the run.
    """

    def __init__(self, task: Task) -> None:
        self.model, self.notebook = Model(task.problem), Notebook(task, monotonic)
        self.free = np.flatnonzero(self.model.upper)
        self.random = np.random.default_rng(task.seed)

    def starts(self, count: int) -> Float[np.ndarray, "count f"]:
        """Give vectors spread evenly, of which most are feasible."""
        return self.model.random_starts(self.random, count)[:, self.free]

    def score_and_missing(self, x: Float[np.ndarray, "b f"]) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
        """Give the logarithm of the score and the missing room as a part of the back's size.

        Raises:
            OverError: the run must end.
        """
        self.notebook.refuse_after_the_end()
        v = np.zeros((len(x), len(self.model.upper)))
        v[:, self.free] = x.clip(0, 1)
        settled, missing = self.model.settle(v)
        score = self.model.score(settled)
        feasible = np.where(missing < ROUNDING, score, np.inf)
        best = int(feasible.argmin())
        self.notebook.tell(feasible[best], lambda: self.model.layout(settled[best]))
        return np.log(score), missing / self.model.size.max()

    def __call__(self, x: Float[np.ndarray, "b f"]) -> Float[np.ndarray, " b"]:
        """Give the price of each vector: log score + PRICE missing / size."""
        score, missing = self.score_and_missing(x)
        return score + PRICE * missing
