"""One job: search, print the design and write its folder. Hydra calls it, in this process or in a worker's.

What costs time to load is loaded inside the functions: Hydra needs this module to answer `--help`, too.
"""

from pathlib import Path
from typing import NoReturn

from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig

from multilens.app.answer import answer
from multilens.app.busy import busy
from multilens.app.ending import BAD_INPUT, BROKEN_PIPE, NOTHING_FOUND, SYSTEM_FAILED, tell
from multilens.app.loading import load_torch
from multilens.app.plain import plain, yaml_text
from multilens.app.refusal import RefusedError
from multilens.app.schema import Config
from multilens.app.search import NothingFoundError
from multilens.app.workers import end_with_parent


def run_job_for_programs(config: DictConfig) -> None:
    """Do what `run_job` does of a job by itself, but print JSON."""
    run_job(config, as_json=True)


def run_job(config: DictConfig, as_json: bool = False) -> None:
    """Make the design that a composed configuration asks for and write its folder, whole or not at all.

    In a sweep a job that finds nothing, or fails, leaves a folder that says why, so that the sweep goes on and its table
    is complete.

    Args:
        config: composed, without Hydra's own part.
        as_json: whether to print JSON instead of words, of a job that is not in a sweep.

    Raises:
        SystemExit: after one line on stderr: nothing was found (3), not in a sweep, the configuration cannot be run or is not
            that of the sweep in whose folder it is (2), or the folder cannot be written (1).
        OSError: the folder cannot be written by a worker of a sweep.
        RefusedError: a worker was started for another sweep than that of the folder.
    """
    from multilens.app import build

    hydra = HydraConfig.get()
    folder, overrides = Path(hydra.runtime.output_dir), list(hydra.overrides.task)
    in_sweep = hydra.mode == RunMode.MULTIRUN
    # Workers of other launchers share one terminal: a bar of each would overwrite the others'.
    in_process = not in_sweep or "basic_launcher" in hydra.launcher._target_
    try:
        # Once and first: the checksum of a drawing is that of the one which is read, whatever becomes of it meanwhile.
        given = build.typed(config)
        if in_sweep:
            end_with_parent()
            from multilens.app.sweep_job import run_sweep_job

            run_sweep_job(given, folder, overrides, in_process)
        else:
            _run_alone(given, folder, overrides, as_json)
    except BrokenPipeError:
        raise SystemExit(BROKEN_PIPE) from None
    except (OSError, RefusedError) as error:
        if not in_process:
            raise
        _leave(BAD_INPUT if isinstance(error, RefusedError) else SYSTEM_FAILED, error)
    finally:
        _remove_if_empty(folder)


def _run_alone(config: Config, folder: Path, overrides: list[str], as_json: bool) -> None:
    load_torch()
    from multilens.app.searched import from_here, log_text, searched
    from multilens.runs import write_run

    marks = _estimates(config)
    try:
        found = searched(config, visible=True)
    except NothingFoundError as reason:
        _leave(NOTHING_FOUND, reason)
    said = "\n\n".join(filter(None, [str(found.design), marks]))
    log = log_text(overrides, *found.log, f"searched for {found.seconds:.1f} s", marks)

    def write() -> list[Path]:
        with busy("drawing the pictures"):
            write_run(folder, found.design, yaml_text(plain(config)), log)
        return [from_here(path) for path in sorted(folder.iterdir())]

    answer(said, found.design, write, as_json)


def _estimates(config: Config) -> str:
    from multilens.app.estimates import notes

    given = [line.partition("=")[0] for line in HydraConfig.get().overrides.task]
    return notes(config, given)


def _leave(code: int, reason: Exception) -> NoReturn:
    # Hydra would add lines of its own to any other exception.
    tell(reason)
    raise SystemExit(code) from None


def _remove_if_empty(folder: Path) -> None:
    """Remove a folder that Hydra made and nothing was put into, and those above it that are empty then, up to where we are."""
    here = Path.cwd()
    for empty in [folder, *(above for above in folder.parents if above != here and above.is_relative_to(here))]:
        try:
            empty.rmdir()
        except OSError:
            # It is not empty, or another process was quicker.
            return
