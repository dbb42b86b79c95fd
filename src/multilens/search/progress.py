"""What the search tells whoever waits for it."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """How far a search has come.

    Args:
        stage: "descent" (all starts at once) or "polish" (the best, one by one).
        done: part of the stage that is done, 0 to 1.
        starts: how many starts there are.
        alive: how many of them are healthy.
        best: score of the best nearly feasible layout so far, mm^2; NaN while there is none.
        seconds_left: estimate until the end, s.
    """

    stage: str
    done: float
    starts: int
    alive: int
    best: float
    seconds_left: float


Listener = Callable[[Progress], None]
