"""Torch, loaded for a command."""

from multilens.app.ending import signals_held


def load_torch() -> None:
    """Load torch while no signal can cut it short, and keep it to one thread from then on.

    What a command computes is small. A second thread gains little there, and where other programs keep the cores busy it
    waits for its turn in every sum: scoring a design took fifty times as long.
    """
    with signals_held():
        import torch
    torch.set_num_threads(1)
