"""The commands, and what each way to end them says and exits with."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from types import FrameType, ModuleType
from typing import NoReturn

from multilens.app.ending import (
    BAD_INPUT,
    BROKEN_PIPE,
    DONE,
    INTERRUPTED,
    SYSTEM_FAILED,
    TERMINATED,
    TerminatedError,
    tell,
)
from multilens.app.help import FLAGS, help_text
from multilens.app.presets import config_folder, preset_groups
from multilens.app.refusal import RefusedError, meant

COMMANDS = ("animate", "design", "evaluate", "explore", "export", "least", "plot", "report", "validate-config")
"""What the first word may be; key=value or a flag in its place means design. NAME is `name_command` of the module
`multilens.app.name`, and its `USAGE` is what `multilens NAME --help` prints."""

VALUED_FLAGS = ("--config-dir", "-cd", "--config-path", "-cp", "--config-name", "-cn", "--package", "-p")
"""Flags of Hydra's whose value is the next word."""


def run_command(given: list[str]) -> int:
    """Run what the command line asks for; everything that goes wrong by input or system is told in one line on stderr.

    Args:
        given: the arguments, without the program's name.

    Returns:
        The exit code.
    """
    try:
        with _terminated_by_signal():
            code = _run(given)
            sys.stdout.flush()
            return code
    except BrokenPipeError:
        # Whoever read the output has seen enough. What Python still holds of it must not be written at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BROKEN_PIPE
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


def _run(given: list[str]) -> int:
    first, rest = _first_word(given)
    named, helped = first in COMMANDS, any(word in FLAGS for word in given)
    if "--version" in given:
        from importlib.metadata import version

        print(f"multilens {version('multilens')}")
    elif named and helped:
        print(_module(first).USAGE)
    elif not given or helped:
        print(help_text(given))
    elif any(word.startswith("query=") for word in given):
        from multilens.app.completion import complete

        complete(given, COMMANDS)
    else:
        _refuse_unknown_command(first)
        return _command(first)(rest) if named else _command("design")(given)
    return DONE


def _first_word(given: list[str]) -> tuple[str, list[str]]:
    """Give the command, also where flags stand before it, and all other words; without one the first word."""
    value = False
    for at, word in enumerate(given):
        if not value and word in COMMANDS:
            return word, given[:at] + given[at + 1 :]
        if not (value or word.startswith("-")):
            break
        value = word in VALUED_FLAGS
    return next(iter(given), ""), given[1:]


def _refuse_unknown_command(first: str) -> None:
    """Refuse a first word that is neither a command nor anything of Hydra's: key=value, ~key or a flag."""
    if first in COMMANDS or "=" in first or first.startswith(("-", "~")):
        return
    begun = next((name for name in COMMANDS if name.startswith(first)), None)
    near = f"; did you mean {begun}?" if begun else meant(first, COMMANDS)
    if first in preset_groups([config_folder()])["experiment"]:
        near = f"; did you mean experiment={first}?"
    raise RefusedError(
        f"the first word must be a command ({', '.join(COMMANDS)}) or key=value, got {first}{near or '; see multilens --help'}"
    )


def _module(name: str) -> ModuleType:
    """Load what runs a command, and nothing of the others."""
    return import_module(f"multilens.app.{name.replace('-', '_')}")


def _command(name: str) -> Callable[[Sequence[str]], int]:
    return getattr(_module(name), f"{name.replace('-', '_')}_command")


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
