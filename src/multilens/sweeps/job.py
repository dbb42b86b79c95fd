"""The folder of one job: a run folder without pictures, and with it the job's row, sealed by checksums.

config.yaml      what was asked, as it was resolved
design.json, layout.csv, sensitivity.csv    as in a run folder, where a design was found
run.log          what the run said
row.json         what came of it as a row of the table, and checksums of the files above
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from multilens.documents import document, document_content, read_text
from multilens.fields import record, text
from multilens.storage import folder_written_whole
from multilens.sweep_row import SweepRow, read_row

if TYPE_CHECKING:
    from multilens.design import Design

ROW = "row.json"
SCHEMA, SCHEMA_VERSION = "multilens.row", 1


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
        content = {"fingerprint": fingerprint, "row": row.record(), "checksums": checksums}
        text = document(SCHEMA, SCHEMA_VERSION, content)
        (inside / ROW).write_text(text, encoding="utf-8", newline="\n")


def read_job(folder: Path) -> Sealed:
    """Read the row of a job; the other files are not looked at.

    Raises:
        ValueError: row.json is damaged.
        OSError: it is not there, or cannot be read.
    """
    content = document_content(read_text(folder / ROW), SCHEMA, SCHEMA_VERSION)
    fields = record(content, ROW, ("fingerprint", "row", "checksums"))
    checksums = record(fields["checksums"], "checksums", (), optional=list(fields["checksums"] or ()))
    return Sealed(text(fields["fingerprint"], "fingerprint"), read_row(fields["row"], "row"), checksums)


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


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None


def _checksum(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()
