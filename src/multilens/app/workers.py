"""Workers of a sweep on the cores of one machine: new ones for each sweep, of one thread each, that end with it."""

import os
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from itertools import starmap
from multiprocessing import parent_process
from threading import Thread
from time import sleep
from typing import Any

from omegaconf import DictConfig

Compute = Callable[[Callable[..., Any], Sequence[tuple[Any, ...]]], Iterable[Any]]
"""What calls a function with the arguments of each task and gives what comes out in their order, such as `itertools.starmap`."""

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
"""Where libraries look, when they are loaded, for how many threads they may have."""

BETWEEN_LOOKS = 1.0
"""s, after which a worker looks again whether its sweep is still there."""


def prepare_workers() -> None:
    """Have every worker that computes from now on be a new process of one thread: workers are as many as there are cores."""
    end_workers()
    os.environ.update(dict.fromkeys(THREADS, "1"))


def computing_as(launcher: DictConfig) -> Compute:
    """Give what computes many tasks as a sweep's launcher does its jobs: in workers by joblib, or else here.

    Args:
        launcher: its configuration.
    """
    if "joblib" not in launcher._target_:
        return starmap

    def compute(function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]]) -> Iterable[Any]:
        from joblib import Parallel, delayed

        return Parallel(launcher.n_jobs, return_as="generator")(delayed(function)(*task) for task in tasks)

    return compute


def end_workers() -> None:
    """End the workers that joblib keeps for whatever this process may do next.

    They stay in the folder in which they were started, have the environment of then, and hold 300 MB each.
    """
    # Without joblib there are none: it is not loaded for this.
    if "joblib" in sys.modules:
        from joblib.externals.loky import get_reusable_executor

        get_reusable_executor().shutdown()


@cache
def end_with_parent() -> None:
    """Have this process, where it is a worker, end soon after the one that started it, which, killed, cannot tell it to."""
    parent = parent_process()
    # Elsewhere than on POSIX systems the number of the parent stays that of the one that is gone.
    if parent is not None and parent.pid is not None and os.name == "posix":
        Thread(target=_end_without, args=(parent.pid,), daemon=True).start()


def _end_without(parent: int) -> None:
    while os.getppid() == parent:
        sleep(BETWEEN_LOOKS)
    os._exit(1)
