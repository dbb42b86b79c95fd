"""The commands, and what each way to end them says and exits with."""

import inspect
import os
import signal
import threading
from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

from multilens.app.ending import BAD_INPUT, DONE, INTERRUPTED, SYSTEM_FAILED, TERMINATED, TerminatedError, tell
from multilens.app.refusal import RefusedError, one_line


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
            if given[:1] == ["evaluate"]:
                return _evaluate(given[1:])
            if given[:1] == ["least"]:
                return _least(given[1:])
            return _plot(given[1:]) if given[:1] == ["plot"] else _design(given)
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


def _plot(given: list[str]) -> int:
    if len(given) != 1 or given[0].startswith("-"):
        raise RefusedError(
            f"plot must be given one run folder, as in multilens plot runs/demo, got {' '.join(given) or 'none'}"
        )
    folder = Path(given[0])
    if not (folder / "design.json").is_file():
        raise RefusedError(
            f"plot: {folder} must be the folder of a run that found a design, there is no design.json in it"
        )
    from multilens.app.loading import load_torch

    load_torch()
    from multilens.runs import redraw

    try:
        redraw(folder)
    except ValueError as error:
        raise RefusedError(f"plot: {error}") from None
    _print_paths(sorted([*folder.glob("*.svg"), *folder.glob("*.png")]))
    return DONE


def _evaluate(given: list[str]) -> int:
    from multilens.app.evaluate import evaluate_command

    return evaluate_command(given)


def _least(given: list[str]) -> int:
    from multilens.app.least import least_command

    return least_command(given)


def _print_paths(paths: list[Path]) -> None:
    for path in paths:
        print(path)


def _design(given: list[str]) -> int:
    import hydra
    from hydra._internal.utils import get_args_parser

    from multilens.app.compose import CONFIG_NAME, VERSION_BASE, config_folder
    from multilens.app.run import run_job
    from multilens.app.schema import register
    from multilens.app.sweep import SweepTable
    from multilens.app.telling import told_in_one_line
    from multilens.app.yaml_limits import refuse_wild_folders

    parser = get_args_parser()
    _tell_in_one_line(parser)
    arguments = parser.parse_args(given)
    if arguments.experimental_rerun is not None:
        raise RefusedError("--experimental-rerun loads a pickle, which can run any code: it must not be given")
    if not (arguments.help or arguments.hydra_help or arguments.shell_completion or arguments.info or arguments.cfg):
        from multilens.app.check import check_command_line

        check_command_line(arguments)
    else:
        refuse_wild_folders(arguments)
    register()
    # Hydra 1.4 takes a list of what its configuration may call in place of the version to be compatible with.
    ours = f"{SweepTable.__module__}.{SweepTable.__qualname__}"
    takes_list = "execution_whitelist" in inspect.signature(hydra.main).parameters
    options: dict[str, Any] = {"execution_whitelist": [ours]} if takes_list else {"version_base": VERSION_BASE}
    start = hydra.main(config_path=str(config_folder()), config_name=CONFIG_NAME, **options)(run_job)
    try:
        with _hydra_raises(), told_in_one_line():
            start()
    except SystemExit as left:
        return left.code if isinstance(left.code, int) else DONE if left.code is None else SYSTEM_FAILED
    except ValueError as error:
        # Flags that exclude each other; Hydra finds out only here.
        if not (arguments.cfg or arguments.info or arguments.shell_completion):
            raise
        raise RefusedError(one_line(str(error))) from None
    return DONE


def _tell_in_one_line(parser: ArgumentParser) -> None:
    def refuse(message: str) -> NoReturn:
        raise RefusedError(f"{message}; multilens --help shows what can be asked")

    parser.error = refuse  # pyright: ignore[reportAttributeAccessIssue] -- the documented way is a subclass, but the parser is Hydra's


@contextmanager
def _hydra_raises() -> Iterator[None]:
    """Have Hydra raise what goes wrong, instead of printing it over several lines and leaving."""
    name = "HYDRA_FULL_ERROR"
    before = os.environ.get(name)
    os.environ[name] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


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
