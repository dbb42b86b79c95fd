"""Two warm processes, one for each core: every run has one to itself, on one thread, with everything loaded beforehand."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from time import monotonic
from typing import Any

from benchmark.found import Task
from benchmark.methods import OURS, PEERS, RIVAL, method
from benchmark.problems import CASES
from benchmark.referee import Judged, judge

CORES = 2

WARM_UP = 1.0
"""s; for each method in each process, before anything counts."""

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Outcome:
    """What came of a run of one method.

    Args:
        judged: what the referee lets count, better and better.
        seconds: that the run took.
        failure: why it ended early or never began; empty where it did not.
    """

    judged: list[Judged]
    seconds: float
    failure: str


class Lanes:
    """Runs methods, one on each core: whoever asks first is served first, and no core waits for the other.

    Args:
        pool: of a process for each core.
    """

    def __init__(self, pool: ProcessPoolExecutor) -> None:
        self.pool = pool

    def ask(self, function: Callable[..., Any], *arguments: object) -> Future:
        """Have a function called in either process."""
        return self.pool.submit(function, *arguments)

    def run(self, name: str, case: str, seed: int, limit: float, goal: float) -> Callable[[], Outcome]:
        """Have a method run, the rival once for each core with starts of its own, and give what waits for the outcome.

        Both runs of the rival know nothing of each other, so that they count as one on both cores whenever each has its turn.
        """
        streams = CORES if name == RIVAL else 1
        asked = [self.ask(_run, name, case, streams * seed + each, limit, goal) for each in range(streams)]
        return lambda: together([each.result() for each in asked])


def together(outcomes: list[Outcome]) -> Outcome:
    """Give what comes of runs that begin at the same time, as if one method had found it all."""
    judged: list[Judged] = []
    for each in sorted((each for outcome in outcomes for each in outcome.judged), key=lambda each: each.seconds):
        if not judged or each.score < judged[-1].score:
            judged.append(each)
    failure = next((outcome.failure for outcome in outcomes if outcome.failure), "")
    return Outcome(judged, max(outcome.seconds for outcome in outcomes), failure)


@contextmanager
def warm_lanes() -> Iterator[Lanes]:
    """Start the processes, load every method in each, and stop them in the end."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    # Read by the libraries when they are loaded, so set before the processes start.
    os.environ |= dict.fromkeys(ONE_THREAD, "1")
    try:
        with ProcessPoolExecutor(CORES, get_context("spawn"), _warm_up) as pool:
            yield Lanes(pool)
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def _warm_up() -> None:
    import torch

    torch.set_num_threads(1)
    for name in (OURS, *PEERS):
        _run(name, CASES[0].name, 0, WARM_UP, 0.0)


def _run(name: str, case: str, seed: int, limit: float, goal: float) -> Outcome:
    problem = next(one for one in CASES if one.name == case).problem
    began = monotonic()
    try:
        found, failure = method(name)(Task(problem, seed, began, limit, goal)), ""
    except Exception as error:
        # Whatever is wrong with one method is a remark in the table and does not keep the others from it.
        found, failure = [], f"{type(error).__name__}: {error}"
    seconds = monotonic() - began
    return Outcome(judge(problem, found), seconds, failure)
