"""Two warm processes, one for each core: what is timed runs in them, on one thread each, with everything loaded beforehand."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
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

WARM_UP = 0.5
"""s; for each method in each process, before anything counts."""

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


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

    def alone(self, name: str, case: str, seed: int, limit: float) -> tuple[list[Judged], float]:
        """Run one method by itself, the rival on both cores; give what the referee lets count, and the seconds it took."""
        began = monotonic() + HEAD_START
        seeds = [CORES * seed + core for core in range(CORES)] if name == RIVAL else [seed]
        told = [self.anywhere(lane, _run, name, case, one, began, limit) for lane, one in enumerate(seeds)]
        done = [one.result() for one in told]
        found = sorted((each for founds, _ in done for each in founds), key=lambda each: each.seconds)
        return self.anywhere(0, _judge, case, found).result(), max(seconds for _, seconds in done)

    def side_by_side(
        self, names: Sequence[str], case: str, seed: int, limit: float
    ) -> list[tuple[list[Judged], float]]:
        """Run one method on each core at the same time, and give for each what `alone` gives."""
        began = monotonic() + HEAD_START
        told = [self.anywhere(lane, _run, name, case, seed, began, limit) for lane, name in enumerate(names)]
        done = [one.result() for one in told]
        judged = [self.anywhere(lane, _judge, case, found) for lane, (found, _) in enumerate(done)]
        return [(one.result(), seconds) for one, (_, seconds) in zip(judged, done, strict=True)]


@contextmanager
def warm_lanes() -> Iterator[Lanes]:
    """Start the processes, load every method in each, and stop them in the end."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    # Read by the libraries when they are loaded, so set before the processes start.
    os.environ |= dict.fromkeys(ONE_THREAD, "1")
    lanes = [ProcessPoolExecutor(1, get_context("spawn"), _keep_to_one_thread) for _ in range(CORES)]
    try:
        for lane in lanes:
            for name in (OURS, *PEERS):
                lane.submit(_run, name, CASES[0].name, 0, monotonic(), WARM_UP).result()
        yield Lanes(lanes)
    finally:
        for lane in lanes:
            lane.shutdown()
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def _keep_to_one_thread() -> None:
    import torch

    torch.set_num_threads(1)


def _run(name: str, case: str, seed: int, began: float, limit: float) -> tuple[list[Found], float]:
    """Run a method; give what it found and the seconds that it took."""
    problem = _problem(case)
    try:
        run = method(name)
    except ImportError:
        return [], 0.0
    sleep(max(0.0, began - monotonic()))
    # A process that is late begins late by its own clock: waiting for the other is not the method's time.
    began = max(began, monotonic())
    return run(Task(problem, seed, began, limit)), monotonic() - began


def _judge(case: str, found: list[Found]) -> list[Judged]:
    return judge(_problem(case), found)


def _problem(case: str) -> Any:
    return next(one for one in CASES if one.name == case).problem
