"""One job of a sweep: computed once, whoever comes and whatever interrupts."""

import traceback
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from omegaconf import OmegaConf

from multilens.app.ending import tell
from multilens.app.loading import keep_what_is_loaded, load_torch
from multilens.app.plain import plain, yaml_text
from multilens.app.refusal import RefusedError, one_line
from multilens.app.schema import Config
from multilens.app.search import NothingFoundError
from multilens.app.searched import from_here, log_text, searched
from multilens.app.sweep_folder import refuse_other_versions
from multilens.app.waiting import leave_waiting
from multilens.storage import made_with
from multilens.sweep_row import FAILED, SweepRow
from multilens.sweeps.claim import read_claim
from multilens.sweeps.fingerprint import asked, difference, fingerprint
from multilens.sweeps.job import OtherJobError, kept_job, row_of, write_job
from multilens.sweeps.locks import AGREEMENT, forget, held_if_free
from multilens.sweeps.table import write_tables_now_and_then

if TYPE_CHECKING:
    from multilens.design import Design

Settings = tuple[tuple[str, str], ...]


def run_sweep_job(config: Config, folder: Path, overrides: Sequence[str], visible: bool) -> None:
    """Compute a job and write its folder, unless that was done before, or is being done by somebody else.

    A job that finds nothing, or fails by a fault of ours, leaves a folder that says why: the sweep goes on.

    Args:
        config: of the job.
        folder: of the job, in the folder of the sweep; its name is the number of the job.
        overrides: words of the command line that make the job.
        visible: whether progress is shown, where there is a terminal.

    Raises:
        RefusedError: the folder holds another job, or the sweep began with other versions; one line.
        OSError: the folder cannot be written.
    """
    with held_if_free(folder.parent, folder.name) as free:
        if free:
            computed = compute_if_missing(config, folder, overrides, visible)
        else:
            leave_waiting(config, folder, overrides)
            print(f"{from_here(folder)}: somebody else is computing it", flush=True)
            return
    if computed:
        keep_what_is_loaded()
        write_tables_now_and_then(folder.parent)


def compute_if_missing(config: Config, folder: Path, overrides: Sequence[str], visible: bool) -> bool:
    """Compute a job whose lock is held and say whether there was anything to compute; see `run_sweep_job`."""
    claim, question = read_claim(folder.parent), plain(config)
    refuse_other_versions(claim)
    mark = fingerprint(question, made_with())
    if (folder.parent / AGREEMENT / folder.name).is_dir():
        from multilens.sweeps.agreement import end_moving_of

        end_moving_of(folder)
    try:
        kept = kept_job(folder, mark, tell)
    except OtherJobError:
        raise RefusedError(_why_another(folder, question)) from None
    if kept is None:
        _compute(config, folder, overrides, claim.fixed, mark, yaml_text(question), visible)
    forget(folder.parent, folder.name)
    return kept is None


def _compute(
    config: Config,
    folder: Path,
    overrides: Sequence[str],
    fixed: Sequence[str],
    mark: str,
    config_text: str,
    visible: bool,
) -> None:
    load_torch(visible)
    from multilens.metrics import in_words
    from multilens.runs import write_design, write_words

    parts = [line.partition("=") for line in overrides]
    settings = tuple((key.lstrip("+~"), value) for key, _, value in parts if key not in fixed)
    job = int(folder.name)

    def save(row: SweepRow, log: Sequence[str], design: "Design | None" = None) -> None:
        def write_files(inside: Path) -> None:
            if design is not None:
                write_design(inside, design)
            write_words(inside, config_text, log_text(overrides, *log))

        write_job(folder, mark, row, write_files)

    try:
        found = searched(config, visible)
        design = _without_commit(found.design)
        row, told = row_of(design, job, settings, found.seconds), in_words(design.problem.metric, design.score, 4)
        save(row, found.log, design)
    except OSError:
        raise
    except Exception as error:
        # A job that fails by a fault of ours must not take the finished ones' table with it.
        row, log = _row_without_design(error, job, settings)
        told = f"{row.status}: {row.reason}"
        save(row, log)
    words = " ".join(f"{key}={value}" for key, value in settings)
    print(": ".join(filter(None, (str(from_here(folder)), words, told))), flush=True)


def _without_commit(design: "Design") -> "Design":
    """Give a design without the commit: a job is the same to the byte wherever the source is, and a commit says more."""
    return design if design.origin is None else replace(design, origin=replace(design.origin, commit=None))


def _row_without_design(error: Exception, job: int, settings: Settings) -> tuple[SweepRow, tuple[str, ...]]:
    """Give the row of a job that left no design, and what is logged of it: of a fault of ours the whole story."""
    reason = one_line(str(error))
    if isinstance(error, NothingFoundError | RefusedError):
        status = "infeasible" if isinstance(error, NothingFoundError) else "refused"
        return SweepRow(job, settings, status, reason), (reason,)
    reason = one_line(f"{type(error).__name__}: {error}")
    return SweepRow(job, settings, FAILED, reason), (traceback.format_exc(), reason)


def _why_another(folder: Path, question: Mapping[str, Any]) -> str:
    """Name what sets the job in a folder apart from the one that is asked."""
    from multilens.runs import CONFIG

    try:
        read: Any = OmegaConf.to_container(OmegaConf.load(folder / CONFIG))
    except OSError:
        read = {}
    told = difference(asked(read), asked(question)) if isinstance(read, dict) else ""
    return f"{folder} holds another job: {told or 'it was made with other versions'}; name another folder, or remove that one"
