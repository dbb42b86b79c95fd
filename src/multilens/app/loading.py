"""Torch, loaded for a command, and how many threads whatever computes may have."""

import os

from multilens.app.busy import busy
from multilens.app.ending import signals_held

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
"""Where libraries look, when they are loaded, for how many threads they may have."""


def one_thread_for_workers() -> None:
    """Have every process that is started from now on compute with one thread: workers are as many as there are cores."""
    os.environ.update(dict.fromkeys(THREADS, "1"))


def load_torch(visible: bool = True) -> None:
    """Load torch while no signal can cut it short, and keep it to one thread from then on.

    What a command computes is small. A second thread gains little there, and where other programs keep the cores busy it
    waits for its turn in every sum: scoring a design took fifty times as long.

    Args:
        visible: whether to tell whoever waits at a terminal.
    """
    # The thread that shows the waiting is begun with the signals held: none must reach Python through it either.
    with signals_held(), busy("loading torch", visible):
        import torch
    torch.set_num_threads(1)
