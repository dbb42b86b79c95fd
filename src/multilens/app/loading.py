"""Torch, loaded for a command."""

from multilens.app.busy import busy
from multilens.app.ending import signals_held


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
