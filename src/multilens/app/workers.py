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

from multilens.sweeps.compute import Compute

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
"""Where libraries look, when they are loaded, for how many threads they may have."""

OF_WORKERS = ("n_jobs", "prefer", "require", "verbose", "temp_folder", "max_nbytes", "mmap_mode")
"""Settings of a launcher by which joblib tells whether its workers will do; else it starts new ones, which takes two seconds."""

BETWEEN_LOOKS = 1.0
"""s, after which a worker looks again whether its sweep is still there."""


def prepare_workers() -> None:
    """Have every worker that computes from now on be a new process of one thread: workers are as many as there are cores."""
    end_workers()
    os.environ.update(dict.fromkeys(THREADS, "1"))


def computing_as(launcher: DictConfig) -> Compute:
    """Give what computes many tasks as a sweep's launcher does its jobs: in the same workers by joblib, or else here.

    Args:
        launcher: its configuration.
    """
    if "joblib" not in launcher._target_:
        return starmap

    def compute(function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]]) -> Iterable[Any]:
        from joblib import Parallel, delayed

        # One task at a time: joblib would put several together, and one worker would wait for the other's at the end.
        settings: dict[str, Any] = {name: _number(launcher[name]) for name in OF_WORKERS if name in launcher}
        settings["batch_size"] = 1
        parallel = Parallel(backend="loky", return_as="generator", **settings)
        return parallel(delayed(function)(*task) for task in tasks)

    return compute


def _number(setting: Any) -> Any:
    """Give a number that stands as a word, as Hydra's launcher does."""
    return int(setting) if isinstance(setting, str) and setting.isdigit() else setting


def end_workers() -> None:
    """End the workers that joblib keeps for whatever this process may do next.

    They stay in the folder in which they were started, have the environment of then, and hold 300 MB each.
    """
    # Without joblib there are none: it is not loaded for this.
    if "joblib" in sys.modules:
        from joblib.externals.loky import get_reusable_executor

        # They have nothing left to do: asked to end, they would take a second to let go of their libraries. What is given
        # here is another executor, which has no workers yet.
        get_reusable_executor(kill_workers=True).shutdown()


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
