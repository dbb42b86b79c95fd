"""What is measured of the runs: how good after a time, and how long until good."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from statistics import median

from benchmark.methods import OURS
from benchmark.referee import Judged

GRACE = 0.25
"""s; by which a run may be late at the end, the same for all: the last layout is handed over after the clock has stopped."""

CLOSE, VERY_CLOSE = 0.01, 0.001
"""Parts of the best known score within which a layout counts as found."""

TIE = 1e-6
"""Part of the best known score that counts as equally good."""


@dataclass(frozen=True)
class Run:
    """One run of one method on one problem.

    Args:
        case: name of the problem.
        method: its name.
        seed: of the run.
        limit: how long it might take, s.
        seconds: that it took in all.
        found: what counts, better and better.
        failure: why it ended early or never began; empty where it did not.
    """

    case: str
    method: str
    seed: int
    limit: float
    seconds: float
    found: tuple[Judged, ...]
    failure: str = ""


def best_at(run: Run, seconds: float) -> float:
    """Give the best score after so many seconds, mm^2; infinity while there is none."""
    return min((each.score for each in run.found if each.seconds <= seconds), default=inf)


def time_to(run: Run, score: float) -> float:
    """Give the seconds until a score was reached; infinity where it was not within the run's limit and the grace."""
    in_time = (each for each in run.found if each.seconds <= run.limit + GRACE)
    return min((each.seconds for each in in_time if each.score <= score), default=inf)


def final(run: Run, limit: float) -> float:
    """Give the best score at the limit, mm^2."""
    return best_at(run, limit + GRACE)


def median_of(numbers: Sequence[float]) -> float:
    """Give the median; of an even number the greater of the middle two, so that infinity is never halved."""
    return median(numbers) if len(numbers) % 2 else sorted(numbers)[len(numbers) // 2]


def is_settled(times: Sequence[float], count: int) -> bool:
    """Give whether the median over `count` runs is already infinite, whatever the runs that are still to come."""
    return times.count(inf) > count // 2


def stopped_too_early(run: Run, best: float) -> bool:
    """Give whether a run ended before its limit at a score that counts for less than the best known, mm^2.

    The search ends by itself; a peer does so where it reaches what was the best known before, which the referee may see otherwise
    and another run may have beaten since.
    """
    return run.method != OURS and not run.failure and run.seconds < run.limit and final(run, inf) > best * (1 + TIE)


def excess(score: float, best: float) -> float:
    """Give how far a score is above the best known, as a part of it."""
    return score / best - 1


def times_shorter(ours: float, theirs: float, limit: float) -> float:
    """Give how many times shorter our time is; at least that where they never got there in their limit, 0 where we did not.

    Where neither got there it is NaN.
    """
    if ours == inf:
        return float("nan") if theirs == inf else 0.0
    return min(theirs, limit) / max(ours, 1e-3)
