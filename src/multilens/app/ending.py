"""How a command ends: its exit codes, and the one line on stderr when it is not done."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from multilens.app.refusal import RefusedError, one_line

DONE, SYSTEM_FAILED, BAD_INPUT, NOTHING_FOUND, INTERRUPTED, BROKEN_PIPE, TERMINATED = 0, 1, 2, 3, 130, 141, 143


class TerminatedError(BaseException):
    """SIGTERM arrived; like a KeyboardInterrupt it is no error that a library should handle."""


def tell(reason: object) -> None:
    """Say on stderr, in one line, why the command is not done."""
    print(f"multilens: {one_line(str(reason))}", file=sys.stderr, flush=True)


def told(error: Exception) -> str:
    """Give what an exception says; of a fault of ours its name as well, for its words alone may be one key."""
    return str(error) if isinstance(error, OSError | ValueError | RefusedError) else f"{type(error).__name__}: {error}"


@contextmanager
def signals_held() -> Iterator[None]:
    """Hold back SIGINT and SIGTERM, to be heard afterwards: an exception in the middle of loading torch aborts the process."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
