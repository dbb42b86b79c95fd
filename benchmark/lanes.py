"""Two warm processes, one for each core: what is timed runs in them, on one thread each, with everything loaded beforehand."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from time import monotonic, sleep
from typing import Any

from benchmark.found import Found, Task
from benchmark.methods import OURS, PEERS, RIVAL, method
from benchmark.problems import CASES
from benchmark.referee import Judged, judge

CORES = 2

HEAD_START = 0.1
"""s; from handing out a task to its beginning, so that both processes begin together."""

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
    """Runs methods: the rival on both cores at once, every other on one.

    Args:
        lanes: one executor of a single process for each core.
    """

    def __init__(self, lanes: Sequence[ProcessPoolExecutor]) -> None:
        self.lanes = lanes

    def anywhere(self, lane: int, function: Callable[..., Any], *arguments: object) -> Future:
        """Call a function in the process of a lane."""
        return self.lanes[lane].submit(function, *arguments)

    def alone(self, name: str, case: str, seed: int, limit: float) -> Outcome:
        """Run one method by itself, the rival on both cores, and judge it."""
        seeds = [CORES * seed + core for core in range(CORES)] if name == RIVAL else [seed]
        told = self._told([(name, one) for one in seeds], case, limit)
        found = sorted((each for one in told for each in one.found), key=lambda each: each.seconds)
        judged = self.anywhere(0, _judge, case, found).result()
        return Outcome(judged, max(one.seconds for one in told), next((one.failure for one in told if one.failure), ""))

    def side_by_side(self, names: Sequence[str], case: str, seed: int, limit: float) -> list[Outcome]:
        """Run one method on each core at the same time, and judge each."""
        told = self._told([(name, seed) for name in names], case, limit)
        judged = [self.anywhere(lane, _judge, case, one.found) for lane, one in enumerate(told)]
        return [Outcome(each.result(), one.seconds, one.failure) for each, one in zip(judged, told, strict=True)]

    def _told(self, runs: Sequence[tuple[str, int]], case: str, limit: float) -> "list[_Told]":
        began = monotonic() + HEAD_START
        asked = [self.anywhere(lane, _run, name, case, seed, began, limit) for lane, (name, seed) in enumerate(runs)]
        return [one.result() for one in asked]


@dataclass(frozen=True)
class _Told:
    """What a process says of a run, before it is judged."""

    found: list[Found]
    seconds: float
    failure: str


@contextmanager
def warm_lanes() -> Iterator[Lanes]:
    """Start the processes, load every method in each, and stop them in the end."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    # Read by the libraries when they are loaded, so set before the processes start.
    os.environ |= dict.fromkeys(ONE_THREAD, "1")
    lanes = [ProcessPoolExecutor(1, get_context("spawn"), _keep_to_one_thread) for _ in range(CORES)]
    try:
        for name in (OURS, *PEERS):
            for warming in [lane.submit(_run, name, CASES[0].name, 0, monotonic(), WARM_UP) for lane in lanes]:
                warming.result()
        yield Lanes(lanes)
    finally:
        for lane in lanes:
            lane.shutdown()
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def _keep_to_one_thread() -> None:
    import torch

    torch.set_num_threads(1)


def _run(name: str, case: str, seed: int, began: float, limit: float) -> _Told:
    problem = _problem(case)
    sleep(max(0.0, began - monotonic()))
    # A process that is late begins late by its own clock: waiting for the other is not the method's time.
    began = max(began, monotonic())
    try:
        found, failure = method(name)(Task(problem, seed, began, limit)), ""
    except Exception as error:
        # Whatever is wrong with one method is a remark in the table and does not keep the others from it.
        found, failure = [], f"{type(error).__name__}: {error}"
    return _Told(found, monotonic() - began, failure)


def _judge(case: str, found: list[Found]) -> list[Judged]:
    return judge(_problem(case), found)


def _problem(case: str) -> Any:
    return next(one for one in CASES if one.name == case).problem
