"""The table of a sweep: gathered from the rows of its jobs, and written for programs and for people."""

import json
import re
from collections.abc import Sequence
from pathlib import Path

from multilens.storage import write_whole
from multilens.sweep_row import UNREADABLE, Cell, SweepRow, cells
from multilens.sweeps.job import ROW, read_job
from multilens.table_text import csv_text, markdown_text

CSV, LINES, MARKDOWN = "table.csv", "table.jsonl", "table.md"


def read_rows(folder: Path) -> tuple[SweepRow, ...]:
    """Gather the rows of a sweep from its job folders, in the order of their numbers.

    A damaged row does not keep the others from the table; its status is "unreadable" and its reason says why.

    Raises:
        OSError: the folder cannot be read.
    """
    jobs = [int(path.name) for path in folder.iterdir() if re.fullmatch("[0-9]{1,18}", path.name)]
    return tuple(_row(folder, job) for job in sorted(jobs) if (folder / str(job) / ROW).exists())


def write_tables(folder: Path) -> tuple[SweepRow, ...]:
    """Write table.csv (all digits), table.jsonl (a JSON object a line) and table.md (to read), each whole; give the rows.

    Raises:
        OSError: the folder cannot be read or written.
    """
    rows = read_rows(folder)
    table = cells(rows)
    write_whole(folder / CSV, csv_text(table))
    write_whole(folder / LINES, "".join(json.dumps(row.record()) + "\n" for row in rows))
    write_whole(folder / MARKDOWN, markdown_text(without_empty_columns(table)))
    return rows


def without_empty_columns(table: Sequence[Sequence[Cell]]) -> list[list[Cell]]:
    """Give a table without the columns that hold nothing in any row."""
    filled = [any(cell not in (None, "") for cell in column[1:]) for column in zip(*table, strict=True)]
    return [[cell for cell, keep in zip(line, filled, strict=True) if keep] for line in table]


def _row(folder: Path, job: int) -> SweepRow:
    try:
        return read_job(folder / str(job)).row
    except (ValueError, OSError) as error:
        return SweepRow(job, (), UNREADABLE, str(error))
