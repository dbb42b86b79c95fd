"""The agreement of a sweep's jobs in its folder: what a job's own search found stays beside what its neighbours led to.

agreement.json   at the top: checksums of what has agreed and of what came of it, and the two scores of each job that became
                 better, alone and agreed
alone.json       in a job's folder: the design that its own search found, where design.json holds a better one

All that changes is first written beside the jobs, whole, and then moved into their folders: whoever comes after an interruption
ends the moving. Nothing is computed again where the same jobs have agreed before and are as that left them.
"""

import os
import shutil
from collections.abc import Iterable, Mapping
from dataclasses import replace
from hashlib import sha256
from itertools import starmap
from pathlib import Path

from multilens.design import Design
from multilens.documents import document, document_content, read_text
from multilens.fields import record, text
from multilens.runs import CONFIG, DESIGN, LOG, write_design
from multilens.storage import folder_written_whole
from multilens.sweep_row import UNREADABLE, SweepRow
from multilens.sweeps.agree import Listener, agree, unlike_neighbours, why_worse
from multilens.sweeps.compute import Compute
from multilens.sweeps.job import ROW, Sealed, read_job, row_of, write_job
from multilens.sweeps.locks import AGREEMENT, forget, held
from multilens.sweeps.table import read_rows

ALONE, MARKER = "alone.json", "agreement.json"
MOVING = AGREEMENT
"""Folder of what is on its way into the jobs' folders."""

SCHEMA, SCHEMA_VERSION = "multilens.agreement", 1


def agree_in(folder: Path, listener: Listener = lambda turn, job: None, compute: Compute = starmap) -> tuple[int, ...]:
    """Let the jobs of a sweep agree, replace the designs that became better, with their rows, and give these jobs.

    Of several processes one does it, and the others wait for what comes of it.

    Args:
        folder: of the sweep.
        listener: told of the pass, from 1, and the job that has been looked at.
        compute: does the work of many jobs, here or elsewhere.

    Raises:
        ValueError: a file of a job is damaged; it is named.
        OSError: the folder cannot be read or written. What has agreed then agrees when it is tried again.
    """
    with held(folder, AGREEMENT):
        _end_moving(folder)
        return _agree(folder, listener, compute)


def end_moving(folder: Path) -> None:
    """Move what an agreement has written into the folders of the jobs, all or what an interruption left of it.

    Raises:
        ValueError: a row that was written is damaged.
        OSError: a file cannot be moved.
    """
    if (folder / MOVING).is_dir():
        with held(folder, AGREEMENT):
            _end_moving(folder)


def end_moving_of(job: Path) -> None:
    """Do what `end_moving` does for one job, whose lock is held.

    Args:
        job: its folder, in that of the sweep.
    """
    _move_job(job.parent / MOVING / job.name, job)


def _agree(folder: Path, listener: Listener, compute: Compute) -> tuple[int, ...]:
    rows = [row for row in read_rows(folder) if row.status != UNREADABLE]
    settings = {row.job: row.settings for row in rows}
    jobs = {row.job: read_job(folder / str(row.job)) for row in rows if row.score is not None}
    inputs = _checksum(jobs, settings)
    if (inputs, _outcome(folder, jobs)) == _agreed_before(folder):
        return tuple(job for job, sealed in jobs.items() if ALONE in sealed.checksums)
    own = {job: Design.load(folder / str(job) / _own_file(sealed)) for job, sealed in jobs.items()}
    now = agree(own, settings, listener, compute)
    near = unlike_neighbours(own, settings)
    better = tuple(job for job in own if now[job] is not own[job])
    with folder_written_whole(folder / MOVING) as inside:
        for job, design in now.items():
            sealed = jobs[job]
            note = why_worse(design, {other: now[other] for other in near[job]})
            row = replace(row_of(design, job, sealed.row.settings, sealed.row.time), note=note)
            if row != sealed.row or (job in better) != (ALONE in sealed.checksums):
                _write_again(inside / str(job), folder / str(job), sealed, row, design, job in better)
        content = {
            "inputs": inputs,
            "outcome": _outcome(folder, jobs, inside),
            "scores": {str(job): [own[job].score, now[job].score] for job in better},
        }
        marker = document(SCHEMA, SCHEMA_VERSION, content)
        (inside / MARKER).write_text(marker, encoding="utf-8", newline="\n")
    _end_moving(folder)
    return better


def _end_moving(folder: Path) -> None:
    moving = folder / MOVING
    if not moving.is_dir():
        return
    for new in sorted(each for each in moving.iterdir() if each.is_dir()):
        with held(folder, new.name):
            _move_job(new, folder / new.name)
            forget(folder, new.name)
    if (moving / MARKER).exists():
        os.replace(moving / MARKER, folder / MARKER)
    moving.rmdir()


def _move_job(new: Path, job: Path) -> None:
    if not new.is_dir():
        # Somebody else came to the job and moved it.
        return
    if not job.is_dir():
        # Somebody removed the job since, to have it computed again.
        shutil.rmtree(new)
        return
    # The row says which files there are, and is moved last.
    if (new / ROW).exists():
        if ALONE not in read_job(new).checksums:
            (job / ALONE).unlink(missing_ok=True)
        for name in sorted((file.name for file in new.iterdir()), key=lambda name: (name == ROW, name)):
            os.replace(new / name, job / name)
    new.rmdir()


def _write_again(new: Path, old: Path, sealed: Sealed, row: SweepRow, design: Design, better: bool) -> None:
    """Write the folder of a job with another design or another row; what was asked and what was said stay."""

    def write_files(inside: Path) -> None:
        write_design(inside, design)
        if better:
            shutil.copyfile(old / _own_file(sealed), inside / ALONE)
        for name in (CONFIG, LOG):
            shutil.copyfile(old / name, inside / name)

    write_job(new, sealed.fingerprint, row, write_files)


def _own_file(sealed: Sealed) -> str:
    return ALONE if ALONE in sealed.checksums else DESIGN


def _checksum(jobs: Mapping[int, Sealed], settings: Mapping[int, tuple[tuple[str, str], ...]]) -> str:
    """Give a checksum of what every job's own search found, and of how the jobs stand to each other."""
    own = {job: sealed.checksums[_own_file(sealed)] for job, sealed in jobs.items()}
    return sha256(repr([(job, settings[job], own.get(job)) for job in sorted(settings)]).encode()).hexdigest()


def _outcome(folder: Path, jobs: Iterable[int], over: Path | None = None) -> str:
    """Give a checksum of the rows of jobs, those laid over them first: they seal all other files."""
    rows = sha256()
    for job in jobs:
        laid_over = None if over is None else over / str(job) / ROW
        row = laid_over if laid_over is not None and laid_over.exists() else folder / str(job) / ROW
        rows.update(row.read_bytes())
    return rows.hexdigest()


def _agreed_before(folder: Path) -> tuple[str, str] | None:
    """Give the checksums of what has agreed in a folder and what came of it; None where nothing has, or nobody can tell."""
    if not (folder / MARKER).exists():
        return None
    try:
        content = document_content(read_text(folder / MARKER), SCHEMA, SCHEMA_VERSION)
        given = record(content, MARKER, ("inputs", "outcome", "scores"))
        return text(given["inputs"], "inputs"), text(given["outcome"], "outcome")
    except ValueError:
        return None
