"""`multilens design`, or no command at all: search for a design, or with -m for many of them, as Hydra composes them."""

import inspect
import os
import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

from multilens.app.ending import DONE, SYSTEM_FAILED
from multilens.app.refusal import RefusedError, one_line


def design_command(words: Sequence[str]) -> int:
    """Run what Hydra's own command line asks for, once all of it has been checked.

    Args:
        words: key=value and Hydra's flags.

    Returns:
        The exit code.

    Raises:
        RefusedError: something cannot be run; one line.
        OSError: a folder cannot be written.
    """
    import hydra
    from hydra._internal.utils import get_args_parser

    from multilens.app.compose import CONFIG_NAME, VERSION_BASE, config_folder
    from multilens.app.launcher import failures_told
    from multilens.app.run import run_job
    from multilens.app.schema import register
    from multilens.app.sweep import SweepTable
    from multilens.app.telling import told_in_one_line
    from multilens.app.yaml_limits import refuse_wild_folders

    parser = get_args_parser()
    _tell_in_one_line(parser)
    arguments = parser.parse_args(list(words))
    if arguments.experimental_rerun is not None:
        raise RefusedError("--experimental-rerun loads a pickle, which can run any code: it must not be given")
    if not (arguments.help or arguments.hydra_help or arguments.shell_completion or arguments.info or arguments.cfg):
        from multilens.app.check import check_command_line

        sweep = check_command_line(arguments)
        if sweep is not None:
            from multilens.app.sweep_folder import open_sweep

            open_sweep(sweep)
            # Told outright, every worker finds the same folder, whatever its job is called.
            words = [*words, _override("hydra.sweep.dir", sweep.folder)]
    else:
        refuse_wild_folders(arguments)
    register()
    # Hydra 1.4 takes a list of what its configuration may call in place of the version to be compatible with.
    ours = f"{SweepTable.__module__}.{SweepTable.__qualname__}"
    takes_list = "execution_whitelist" in inspect.signature(hydra.main).parameters
    options: dict[str, Any] = {"execution_whitelist": [ours]} if takes_list else {"version_base": VERSION_BASE}
    start = hydra.main(config_path=str(config_folder()), config_name=CONFIG_NAME, **options)(run_job)
    try:
        with _hydra_raises(), _in_argv(words), told_in_one_line(), failures_told():
            start()
    except SystemExit as left:
        return left.code if isinstance(left.code, int) else DONE if left.code is None else SYSTEM_FAILED
    except ValueError as error:
        # Flags that exclude each other; Hydra finds out only here.
        if not (arguments.cfg or arguments.info or arguments.shell_completion):
            raise
        raise RefusedError(one_line(str(error))) from None
    return DONE


def _override(key: str, folder: Path) -> str:
    """Give key=folder as Hydra reads it, whatever the folder is called."""
    text = str(folder).replace("\\", "\\\\").replace("'", "\\'")
    return f"{key}='{text}'"


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
def _in_argv(words: Sequence[str]) -> Iterator[None]:
    """Have Hydra, which reads them there, find these words alone behind the program's name."""
    before = sys.argv
    sys.argv = [before[0], *words]
    try:
        yield
    finally:
        sys.argv = before
