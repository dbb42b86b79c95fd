"""Who may write what in the folder of a sweep, among all processes on all computers that see it.

Whoever writes NAME, or anything called NAME and more, holds the lock of NAME. The system frees the locks of a process that ends,
however it ends. So what lies half written beside NAME while its lock is free was left by somebody who is gone.
"""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from multilens.storage import write_whole

TABLE, AGREEMENT, CLAIM, PICTURES = "table", "agreement", "sweep", "pictures"
"""What there is to write besides the jobs, whose locks are called by their numbers."""

BETWEEN_LOOKS = 0.2
"""s, for whoever waits."""


@contextmanager
def held(folder: Path, name: str) -> Iterator[None]:
    """Hold a lock; wait until it is free.

    Args:
        folder: of the sweep.
        name: of what is to be written.
    """
    with FileLock(_lock_file(folder, name), poll_interval=BETWEEN_LOOKS):
        yield


@contextmanager
def held_if_free(folder: Path, name: str) -> Iterator[bool]:
    """Hold a lock if nobody else does, and say whether it is held; see `held`."""
    lock = FileLock(_lock_file(folder, name), timeout=0)
    try:
        lock.acquire()
    except Timeout:
        yield False
        return
    try:
        yield True
    finally:
        lock.release()


def forget(folder: Path, name: str) -> None:
    """Remove the file of a lock that is held, once there is nothing left to be written under it.

    Somebody may hold the old file then while somebody else holds a new one: both must find that nothing is left to do.
    """
    _lock_file(folder, name).unlink(missing_ok=True)


def write_held(path: Path, content: str) -> None:
    """Write a file into the folder of a sweep, whole or not at all, with its lock held; see `held` and `write_whole`."""
    with held(path.parent, path.name.split(".")[0]):
        write_whole(path, content)


def clear_half_written(folder: Path) -> None:
    """Remove what processes that were killed have left half written in the folder of a sweep."""
    for left in folder.glob(".*.partial-*"):
        with held_if_free(folder, left.name.split(".")[1]) as free:
            if free and left.is_dir():
                shutil.rmtree(left)
            elif free:
                left.unlink(missing_ok=True)


def free_lock(folder: Path, name: str) -> FileLock:
    """Give a lock that is not held, for a library that acquires and releases it by itself."""
    return FileLock(_lock_file(folder, name))


def _lock_file(folder: Path, name: str) -> Path:
    return folder / f".{name}.lock"
