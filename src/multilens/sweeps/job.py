"""The folder of one job: a run folder without pictures, and with it the job's row, sealed by checksums.

config.yaml      what was asked, as it was resolved
design.json, layout.csv, sensitivity.csv    as in a run folder, where a design was found
run.log          what the run said
row.json         what came of it as a row of the table, and checksums of the files above
time.json        how long the search took: the one file that is not the same to the byte when the job is computed again
"""

import json
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from multilens.documents import document, document_content, read_text
from multilens.fields import number, record, text
from multilens.storage import folder_written_whole, holds_something, set_aside
from multilens.sweep_row import FAILED, UNREADABLE, SweepRow, read_row
from multilens.sweeps.locks import forget, held_if_free

if TYPE_CHECKING:
    from multilens.design import Design

ROW, TIME = "row.json", "time.json"
SCHEMA, SCHEMA_VERSION = "multilens.row", 1


class OtherJobError(ValueError):
    """The folder of a job holds the answer to another question, or one that was made with other versions."""


@dataclass(frozen=True)
class Sealed:
    """What row.json holds.

    Args:
        fingerprint: of what was asked and of what answered it.
        row: what came of it.
        checksums: of the other files of the folder, by name.
    """

    fingerprint: str
    row: SweepRow
    checksums: Mapping[str, str]


def write_job(folder: Path, fingerprint: str, row: SweepRow, write_files: Callable[[Path], None]) -> None:
    """Write the folder of a job, whole or not at all.

    Args:
        folder: where it goes; may be there already if it is empty. Its parent must exist.
        fingerprint: of what was asked and of what answered it.
        row: what came of it.
        write_files: writes everything but the row into the empty folder that it is given.

    Raises:
        FileExistsError: something is in the folder already.
        OSError: it cannot be written, or the disk is full; nothing is left behind then.
    """
    with folder_written_whole(folder) as inside:
        write_files(inside)
        checksums = {file.name: _checksum(file) for file in sorted(inside.iterdir())}
        content = {"fingerprint": fingerprint, "row": replace(row, time=None).record(), "checksums": checksums}
        _write(inside / ROW, document(SCHEMA, SCHEMA_VERSION, content))
        _write(inside / TIME, json.dumps({"time_s": row.time}) + "\n")


def read_job(folder: Path) -> Sealed:
    """Read the row of a job, and its time where that can be read; the other files are not looked at.

    Raises:
        ValueError: row.json is damaged.
        OSError: it is not there, or cannot be read.
    """
    content = document_content(read_text(folder / ROW), SCHEMA, SCHEMA_VERSION)
    fields = record(content, ROW, ("fingerprint", "row", "checksums"))
    checksums = record(fields["checksums"], "checksums", (), optional=list(fields["checksums"] or ()))
    row = replace(read_row(fields["row"], "row"), time=_time(folder))
    return Sealed(text(fields["fingerprint"], "fingerprint"), row, checksums)


def kept_job(folder: Path, fingerprint: str, listener: Callable[[str], None] = lambda line: None) -> Sealed | None:
    """Give what the folder of a job holds of an earlier run, if it need not be computed again.

    What is damaged is set aside. Whoever calls this holds the job's lock.

    Args:
        folder: of the job, there or not.
        fingerprint: of what is asked and of what would answer it.
        listener: told in one line of what is set aside.

    Raises:
        OtherJobError: the folder was written for another fingerprint.
        OSError: it cannot be read or renamed.
    """
    if not holds_something(folder):
        return None
    try:
        sealed = read_job(folder)
        refuse_damaged(folder, sealed)
    except (ValueError, FileNotFoundError, NotADirectoryError) as damage:
        reason = damage if isinstance(damage, ValueError) else f"{ROW} is missing"
        listener(f"{folder}: {reason}; set aside as {set_aside(folder).name}, computed again")
        return None
    if sealed.fingerprint != fingerprint:
        raise OtherJobError(f"{folder} holds another job")
    return sealed


def forget_failed(sweep: Path) -> int:
    """Remove the folders of jobs that failed by a fault, so that they are tried again, and give how many others there are.

    Args:
        sweep: folder of the sweep.

    Raises:
        OSError: a folder cannot be read or removed.
    """
    others = 0
    for row in sweep.glob(f"[0-9]*/{ROW}"):
        if not row.parent.name.isdecimal():  # set aside
            continue
        with held_if_free(sweep, row.parent.name) as free:
            if free and _status(row.parent) == FAILED:
                shutil.rmtree(row.parent)
            else:
                others += 1
            if free:
                forget(sweep, row.parent.name)
    return others


def refuse_damaged(folder: Path, sealed: Sealed) -> None:
    """Refuse a folder of whose files one is not as it was sealed; others may have come, such as pictures.

    Raises:
        ValueError: a file is missing or altered; it is named.
        OSError: one cannot be read.
    """
    for name, checksum in sealed.checksums.items():
        if not (folder / name).is_file():
            raise ValueError(f"{name} is missing")
        if _checksum(folder / name) != checksum:
            raise ValueError(f"{name} was altered")


def row_of(design: "Design", job: int, settings: tuple[tuple[str, str], ...], time: float | None) -> SweepRow:
    """Give the row of a job that found a design.

    Args:
        design: feasible.
        job: its number.
        settings: the swept keys and their values.
        time: that the search took, s.
    """
    from torch import pi

    from multilens.constraints import body_radius

    problem, layout, metric, longest = design.problem, design.layout, design.problem.metric, design.longest_baseline
    bound = None if design.bound is None else design.bound.value
    return SweepRow(
        job,
        settings,
        design.status,
        lens_count=layout.count,
        metric=None if metric is None else metric.name,
        figure=_finite(design.figure),
        unit=None if metric is None else metric.unit,
        score=_finite(design.score),
        rmse=_finite(design.rmse),
        measured=_finite(design.measured),
        bound=bound,
        gap=_finite(design.gap),
        longest_baseline=None if longest is None else longest[0],
        aperture_area=pi * layout.aperture_radius.square().sum().item(),
        body_area=pi * body_radius(layout, problem.lenses).square().sum().item(),
        back_area=problem.back.outline.area,
        time=time,
    )


def _status(folder: Path) -> str:
    try:
        return read_job(folder).row.status
    except (ValueError, FileNotFoundError):
        return UNREADABLE


def _time(folder: Path) -> float | None:
    """Give the time that a job took; None where it found nothing, or where nobody can tell any more."""
    try:
        return number(json.loads(read_text(folder / TIME))["time_s"], TIME)
    except (ValueError, TypeError, KeyError, RecursionError, FileNotFoundError):
        return None


def _write(path: Path, text: str) -> None:
    path.write_bytes(text.encode())


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None


def _checksum(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()
