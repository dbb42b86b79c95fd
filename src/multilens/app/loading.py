"""Torch, loaded for a command, and all that is loaded, kept from being looked at again."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from multilens.app.busy import busy
from multilens.app.ending import signals_held


def load_torch(visible: bool = True) -> None:
    """Load torch while no signal can cut it short, and keep it to one thread from then on.

    What a command computes is small. A second thread gains little there, and where other programs keep the cores busy it
    waits for its turn in every sum: scoring a design took fifty times as long.

    Args:
        visible: whether to tell whoever waits at a terminal.
    """
    if "torch" not in sys.modules:
        # The thread that shows the waiting is begun with the signals held: none must reach Python through it either.
        with signals_held(), busy("loading torch", visible), _nothing_collected():
            import torch
    import torch

    torch.set_num_threads(1)


@cache
def keep_what_is_loaded() -> None:
    """Have Python's collector of garbage pass over what this process holds by now, which is libraries and stays.

    They are a third of a million objects. To look through them again and again took a fifth of the time of a sweep of small jobs.
    """
    gc.freeze()


@contextmanager
def _nothing_collected() -> Iterator[None]:
    """Have the collector wait while a library is loaded, which leaves no garbage, and pass over it then: a fifth of the time."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.freeze()
