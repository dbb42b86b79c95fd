"""One job: search, print the design and write its folder. Hydra calls it, in this process or in a worker's.

What costs time to load is loaded inside the functions: Hydra needs this module to answer `--help`, too.
"""

import traceback
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, NoReturn

from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf

from multilens.app.ending import BAD_INPUT, NOTHING_FOUND, SYSTEM_FAILED, tell
from multilens.app.loading import load_torch
from multilens.app.refusal import RefusedError, one_line
from multilens.app.search import NothingFoundError, search
from multilens.app.tolerance import build_tolerance

if TYPE_CHECKING:
    from multilens.design import Design


def run_job(config: DictConfig) -> None:
    """Make the design that a composed configuration asks for and write its folder, whole or not at all.

    In a sweep a job that finds nothing, or fails, leaves a folder that says why, so that the sweep goes on and its table
    is complete.

    Args:
        config: composed, without Hydra's own part.

    Raises:
        SystemExit: after one line on stderr: nothing was found (3), the configuration cannot be run (2), both not in a sweep,
            or the folder cannot be written (1).
        OSError: the folder cannot be written by a worker of a sweep.
    """
    hydra = HydraConfig.get()
    folder = Path(hydra.runtime.output_dir)
    in_sweep = hydra.mode == RunMode.MULTIRUN
    log: list[str] = [" ".join(["multilens", *hydra.overrides.task])]
    # Workers of other launchers share one terminal: a bar of each would overwrite the others'.
    in_process = not in_sweep or "basic_launcher" in hydra.launcher._target_
    try:
        load_torch()
        if in_sweep:
            _run_sweep_job(config, folder, list(hydra.overrides.task), log, in_process)
        else:
            _run_alone(config, folder, log)
    except OSError as error:
        if not in_process:
            raise
        _leave(SYSTEM_FAILED, error)
    finally:
        _remove_if_empty(folder)


def _run_alone(config: DictConfig, folder: Path, log: list[str]) -> None:
    from multilens.runs import write_run

    try:
        design = _search(config, log, visible=True)
    except NothingFoundError as reason:
        _leave(NOTHING_FOUND, reason)
    except RefusedError as refusal:
        _leave(BAD_INPUT, refusal)
    print(design)
    marks = _estimates(config)
    if marks:
        print(f"\n{marks}")
        log.append(marks)
    write_run(folder, design, _text(config), _lines(log))
    print()
    for path in sorted(folder.iterdir()):
        print(_from_here(path))


def _estimates(config: DictConfig) -> str:
    from multilens.app import build
    from multilens.app.estimates import notes

    given = [line.partition("=")[0] for line in HydraConfig.get().overrides.task]
    return notes(build.typed(config), given)


def _run_sweep_job(config: DictConfig, folder: Path, overrides: list[str], log: list[str], visible: bool) -> None:
    from multilens.metrics import in_words
    from multilens.runs import write_design, write_words
    from multilens.sweep_row import SweepRow
    from multilens.sweeps.job import row_of, write_job

    label, began, design, status, line = f"{_from_here(folder)}: {' '.join(overrides)}", monotonic(), None, "", ""
    settings = tuple((key, value) for key, _, value in (line.partition("=") for line in overrides))
    try:
        design = _search(config, log, visible)
    except (NothingFoundError, RefusedError) as reason:
        status, line = "infeasible" if isinstance(reason, NothingFoundError) else "refused", one_line(str(reason))
    except OSError:
        raise
    except Exception as error:
        # A job that fails by a fault of ours must not take the finished ones' table with it; its log has the whole story.
        status, line = "failed", one_line(f"{type(error).__name__}: {error}")
        log.append(traceback.format_exc())
    if design is None:
        log.append(line)
        row, told = SweepRow(int(folder.name), settings, status, line), f"{status}: {line}"
    else:
        row = row_of(design, int(folder.name), settings, monotonic() - began)
        told = in_words(design.problem.metric, design.score, 4)

    def write_files(inside: Path) -> None:
        if design is not None:
            write_design(inside, design)
        write_words(inside, _text(config), _lines(log))

    write_job(folder, "", row, write_files)
    print(f"{label}: {told}", flush=True)


def _search(config: DictConfig, log: list[str], visible: bool) -> "Design":
    from multilens.app import build
    from multilens.app.terminal import progress_bar

    given = build.typed(config)
    build.check(given)
    problem, began = build.build_question(given), monotonic()
    with progress_bar(log, visible) as listener:
        found = search(problem, given, listener)
    design = replace(found, tolerance=build_tolerance(given.tolerance))
    log += [f"searched for {monotonic() - began:.1f} s: {design.status}", str(design)]
    if not design.feasible:
        raise NothingFoundError(design.reason)
    return design


def _leave(code: int, reason: Exception) -> NoReturn:
    # Hydra would add lines of its own to any other exception.
    tell(reason)
    raise SystemExit(code) from None


def _text(config: DictConfig) -> str:
    return OmegaConf.to_yaml(config, resolve=True)


def _lines(log: list[str]) -> str:
    return "\n".join(log) + "\n"


def _from_here(path: Path) -> Path:
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def _remove_if_empty(folder: Path) -> None:
    """Remove a folder that Hydra made and nothing was put into, and those above it that are empty then, up to where we are."""
    here = Path.cwd()
    for empty in [folder, *(above for above in folder.parents if above != here and above.is_relative_to(here))]:
        if not empty.is_dir() or any(empty.iterdir()):
            return
        empty.rmdir()
