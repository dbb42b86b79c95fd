"""Random search as wind farms are laid out with: move one lens at random, keep what is better, begin anew when nothing is.

Reference:
    J. Feng and W. Z. Shen, Solving the wind farm layout optimization problem using random search algorithm, 2015.
"""

import numpy as np

from benchmark.found import Found, OverError, Task
from benchmark.peers.priced import Priced

TRIED = 64
"""Moves that are tried at once, of which the best is kept if it is better."""

PATIENCE = 150
"""Rounds without anything better after which it begins anew."""


def random_search(task: Task) -> list[Found]:
    """Move lenses until the clock stops."""
    price = Priced(task)
    n = price.model.n
    lens_of = np.concatenate([np.repeat(np.arange(n), 2), np.arange(n), np.arange(n)])[price.free]
    try:
        while True:
            starts = price.starts(TRIED)
            prices = price(starts)
            x, best, since = starts[prices.argmin()], prices.min(), 0
            while since < PATIENCE:
                # Steps of every size, from the whole range down to a ten-thousandth of it.
                reach = 10 ** price.random.uniform(-4, 0, (TRIED, 1))
                moved = lens_of == price.random.integers(n, size=(TRIED, 1))
                moved &= price.random.uniform(size=moved.shape) < 0.6
                tried = (x + moved * reach * price.random.uniform(-1, 1, moved.shape)).clip(0, 1)
                prices = price(tried)
                since += 1
                if prices.min() < best:
                    x, best, since = tried[prices.argmin()], prices.min(), 0
    except OverError:
        return price.notebook.all()
