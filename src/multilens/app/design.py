"""`multilens design`, or no command at all: search for a design, or with -m for many of them, as Hydra composes them."""

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

from multilens.app.answer import FLAG, without_flag
from multilens.app.ending import DONE, SYSTEM_FAILED
from multilens.app.refusal import RefusedError, one_line

USAGE = """\
multilens design key=value ...    search for a design, and save a run folder

`design` may be left out. The words are Hydra's: group=option takes a preset, key=value sets one key, +key=value adds one,
~key takes one away. `multilens --help` lists the presets, `multilens --cfg job experiment=NAME` the keys.

Options
  -m, --multirun           one design for every combination of values, as in lenses.count=2,3,4, and a table of all
  --json                   print the design and the paths of its files as JSON, and nothing else
  --cfg job                print the configuration that would be run, and run nothing
  --config-dir FOLDER      take presets of your own as well
  hydra.run.dir=FOLDER     where the run folder goes (runs/NAME/DATE_TIME)
  hydra.sweep.dir=FOLDER   where the folder of a sweep goes (sweeps/NAME/MARK, by its words)

Examples
  multilens design experiment=demo
  multilens design experiment=phone_back lenses.count=3 search=quick hydra.run.dir=runs/three
  multilens design experiment=demo search.time_limit=20 --json
  multilens design -m experiment=phone_back lenses.count=2,3,4,5

Exit code 3: nothing fits, or nothing was found. `multilens validate-config` tells without a search what it can."""


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

    from multilens.app.compose import CONFIG_NAME, IS_1_3, VERSION_BASE
    from multilens.app.launcher import failures_told
    from multilens.app.presets import config_folder
    from multilens.app.run import run_job, run_job_for_programs
    from multilens.app.schema import register
    from multilens.app.sweep import SweepTable
    from multilens.app.telling import told_in_one_line
    from multilens.app.yaml_limits import refuse_wild_folders
    from multilens.sweeps.table import write_tables

    as_json, words = without_flag(words)
    arguments = read_arguments(words)
    flags = _flags(words, arguments)
    sweep = None
    if not (arguments.help or arguments.hydra_help or arguments.shell_completion or arguments.info or arguments.cfg):
        from multilens.app.check import check_command_line

        sweep = check_command_line(arguments).sweep
        if sweep is not None:
            if as_json:
                raise RefusedError(
                    f"{FLAG} is for one design: of a sweep, table.jsonl in its folder has a JSON object for each job"
                )
            from multilens.app.sweep_folder import open_sweep

            open_sweep(sweep)
            # Told outright, every worker finds the same folder, whatever its job is called.
            arguments.overrides.append(_override("hydra.sweep.dir", sweep.folder))
    else:
        refuse_wild_folders(arguments)
    register()
    # Hydra 1.4 takes a list of what its configuration may call in place of the version to be compatible with.
    ours = f"{SweepTable.__module__}.{SweepTable.__qualname__}"
    options: dict[str, Any] = {"version_base": VERSION_BASE} if IS_1_3 else {"execution_whitelist": [ours]}
    start = hydra.main(config_path=str(config_folder()), config_name=CONFIG_NAME, **options)(
        run_job_for_programs if as_json else run_job
    )
    try:
        # Hydra is to raise what goes wrong, instead of printing it over several lines and leaving.
        quiet = environment("HYDRA_FULL_ERROR", "1")
        with quiet, _in_argv([*arguments.overrides, *flags]), told_in_one_line(), failures_told():
            start()
    except OSError:
        # The sweep's end was not reached: what is done is in the table all the same.
        if sweep is not None:
            write_tables(sweep.folder)
        raise
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


def read_arguments(words: Sequence[str]) -> Namespace:
    """Give what Hydra's parser makes of words; one that it does not take is told in one line."""
    from hydra._internal.utils import get_args_parser

    parser = get_args_parser()
    _tell_in_one_line(parser)
    arguments = parser.parse_intermixed_args(list(words))
    if arguments.experimental_rerun is not None:
        raise RefusedError("--experimental-rerun loads a pickle, which can run any code: it must not be given")
    return arguments


def _flags(words: Sequence[str], arguments: Namespace) -> list[str]:
    """Give the words that are not overrides; Hydra takes them only in front of those or behind, not between."""
    flags = list(words)
    for override in arguments.overrides:
        flags.remove(override)
    return flags


def _tell_in_one_line(parser: ArgumentParser) -> None:
    def refuse(message: str) -> NoReturn:
        raise RefusedError(f"{message}; multilens --help shows what can be asked")

    parser.error = refuse  # pyright: ignore[reportAttributeAccessIssue] -- the documented way is a subclass, but the parser is Hydra's


@contextmanager
def environment(name: str, value: str) -> Iterator[None]:
    """Set a variable of the environment for a while."""
    before = os.environ.get(name)
    os.environ[name] = value
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
