"""One job of a sweep: computed once, whoever comes and whatever interrupts."""

import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from multilens.app.ending import tell
from multilens.app.loading import load_torch
from multilens.app.plain import plain, yaml_text
from multilens.app.refusal import RefusedError, one_line
from multilens.app.search import NothingFoundError
from multilens.app.searched import Searched, from_here, log_text, searched
from multilens.app.sweep_folder import refuse_other_versions
from multilens.app.waiting import leave_waiting
from multilens.storage import made_with
from multilens.sweep_row import FAILED, SweepRow
from multilens.sweeps.claim import read_claim
from multilens.sweeps.fingerprint import asked, difference, fingerprint
from multilens.sweeps.job import OtherJobError, kept_job, row_of, write_job
from multilens.sweeps.locks import forget, held_if_free
from multilens.sweeps.table import write_tables_now_and_then


def run_sweep_job(config: DictConfig, folder: Path, overrides: Sequence[str], visible: bool) -> None:
    """Compute a job and write its folder, unless that was done before, or is being done by somebody else.

    A job that finds nothing, or fails by a fault of ours, leaves a folder that says why: the sweep goes on.

    Args:
        config: composed, without Hydra's own part.
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
        write_tables_now_and_then(folder.parent)


def compute_if_missing(config: DictConfig, folder: Path, overrides: Sequence[str], visible: bool) -> bool:
    """Compute a job whose lock is held and say whether there was anything to compute; see `run_sweep_job`."""
    claim, question = read_claim(folder.parent), plain(config)
    refuse_other_versions(claim)
    mark = fingerprint(question, made_with())
    try:
        kept = kept_job(folder, mark, tell)
    except OtherJobError:
        raise RefusedError(_why_another(folder, question)) from None
    if kept is None:
        _compute(config, folder, overrides, claim.fixed, mark, yaml_text(question), visible)
    forget(folder.parent, folder.name)
    return kept is None


def _compute(
    config: DictConfig,
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
    found, job = _searched(config, visible), int(folder.name)
    if isinstance(found, Searched):
        row, lines = row_of(found.design, job, settings, found.seconds), found.log
        told = in_words(found.design.problem.metric, found.design.score, 4)
    else:
        row, lines = SweepRow(job, settings, found.status, found.reason), found.log
        told = f"{row.status}: {row.reason}"

    def write_files(inside: Path) -> None:
        if isinstance(found, Searched):
            write_design(inside, found.design)
        write_words(inside, config_text, log_text(overrides, *lines))

    write_job(folder, mark, row, write_files)
    print(f"{from_here(folder)}: {' '.join(f'{key}={value}' for key, value in settings)}: {told}", flush=True)


@dataclass(frozen=True)
class _Nothing:
    """Why there is no design: the status of the row, the reason in one line, and what is logged of it."""

    status: str
    reason: str
    log: tuple[str, ...]


def _searched(config: DictConfig, visible: bool) -> Searched | _Nothing:
    try:
        return searched(config, visible)
    except (NothingFoundError, RefusedError) as error:
        reason = one_line(str(error))
        return _Nothing("infeasible" if isinstance(error, NothingFoundError) else "refused", reason, (reason,))
    except OSError:
        raise
    except Exception as error:
        # A job that fails by a fault of ours must not take the finished ones' table with it; its log has the whole story.
        reason = one_line(f"{type(error).__name__}: {error}")
        return _Nothing(FAILED, reason, (traceback.format_exc(), reason))


def _why_another(folder: Path, question: Mapping[str, Any]) -> str:
    """Name what sets the job in a folder apart from the one that is asked."""
    from multilens.runs import CONFIG

    try:
        read: Any = OmegaConf.to_container(OmegaConf.load(folder / CONFIG))
    except OSError:
        read = {}
    told = difference(asked(read), asked(question)) if isinstance(read, dict) else ""
    return f"{folder} holds another job: {told or 'it was made with other versions'}; name another folder, or remove that one"
