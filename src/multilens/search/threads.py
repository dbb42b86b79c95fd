"""One thread for the whole of a search: as fast as two, and the same to the bit on any number of cores."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

import torch
from threadpoolctl import ThreadpoolController


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep torch and the linear algebra under SciPy to one thread, and give them back what they had.

    On tensors of this size a second thread gains nothing and waits for the first when cores are busy: with two busy processes
    beside it, a search on two threads took seven times as long as on one. And a library that shares its sums among threads
    rounds them in another order, which is enough to lead a polish to another optimum.
    """
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with _libraries().limit(limits=1, user_api="blas"):
            yield
    finally:
        torch.set_num_threads(threads)


@cache
def _libraries() -> ThreadpoolController:
    """Give the libraries with threads of their own; looking for them takes milliseconds and is done once."""
    # A library can only be held to one thread once it is loaded.
    import scipy.optimize  # noqa: F401

    return ThreadpoolController()
