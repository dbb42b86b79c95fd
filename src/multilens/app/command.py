"""The commands, and what each way to end them says and exits with."""

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.metadata import version
from types import FrameType
from typing import NoReturn

from multilens.app.ending import BAD_INPUT, DONE, INTERRUPTED, SYSTEM_FAILED, TERMINATED, TerminatedError, tell
from multilens.app.refusal import RefusedError

COMMANDS = ("design", "evaluate", "export", "least", "plot", "report")
"""What the first word may be; without one of them it is design. NAME is `name_command` of the module `multilens.app.name`."""


def run_command(given: list[str]) -> int:
    """Run what the command line asks for; everything that goes wrong by input or system is told in one line on stderr.

    Args:
        given: the arguments, without the program's name.

    Returns:
        The exit code.
    """
    try:
        with _terminated_by_signal():
            if "--version" in given:
                print(f"multilens {version('multilens')}")
                return DONE
            named = given[:1] and given[0] in COMMANDS
            return _command(given[0])(given[1:]) if named else _command("design")(given)
    except RefusedError as refusal:
        reason, code = refusal, BAD_INPUT
    except KeyboardInterrupt:
        reason, code = "interrupted; nothing half done is left, what was finished before is whole", INTERRUPTED
    except TerminatedError:
        reason, code = "terminated; nothing half done is left, what was finished before is whole", TERMINATED
    except OSError as error:
        reason, code = error, SYSTEM_FAILED
    tell(reason)
    return code


def _command(name: str) -> Callable[[Sequence[str]], int]:
    """Load what runs a command, and nothing of the others."""
    module = name.replace("-", "_")
    return getattr(import_module(f"multilens.app.{module}"), f"{module}_command")


@contextmanager
def _terminated_by_signal() -> Iterator[None]:
    """Turn SIGTERM into an exception, so that what was begun is cleaned up; only the main thread can."""

    def terminate(number: int, frame: FrameType | None) -> NoReturn:
        raise TerminatedError

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
