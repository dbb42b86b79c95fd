"""What the search tells whoever waits for it."""

from collections.abc import Callable
from dataclasses import dataclass

from multilens.layout import Layout
from multilens.metrics import Metric

BOUND = "bound"
"""The stage after the search, in which what no layout can beat is sought."""


@dataclass(frozen=True)
class Progress:
    """How far a search has come.

    Args:
        stage: "starts" (fresh ones, a batch at a time), "variations" (of the best so far), "polish" (the last digits) or
            "bound" (what no layout beats).
        done: part of the stage that is done, 0 to 1; of the bound 0.
        starts: how many fresh starts there have been so far.
        alive: how many of them, and of the layouts that were known before, are healthy.
        best: score of the best layout so far that is proved feasible; NaN while there is none.
        layout: that layout; None while there is none.
        seconds_left: estimate until the end, s.
        metric: how the score reads; None for a score of one's own.
    """

    stage: str
    done: float
    starts: int
    alive: int
    best: float
    layout: Layout | None
    seconds_left: float
    metric: Metric | None = None


Listener = Callable[[Progress], None]
