"""The table of a sweep: gathered from the rows of its jobs, and written for programs and for people."""

import json
import math
import os
import re
import time
from collections.abc import Sequence
from pathlib import Path

from multilens.storage import write_whole
from multilens.sweep_row import UNREADABLE, Cell, SweepRow, cells
from multilens.sweeps.job import ROW, read_job
from multilens.sweeps.locks import TABLE, held, held_if_free
from multilens.table_text import csv_text, markdown_text

CSV, LINES, MARKDOWN = "table.csv", "table.jsonl", "table.md"

LEAST_AGE = 2.0
"""s that a table stands before a sweep that is running writes it again."""

AGE_PER_BYTE = 3e-5
"""s longer for each byte of table.jsonl. A row has 600 bytes and takes some 0.4 ms to read, 2 % of which may go into tables."""


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
    with held(folder, TABLE):
        return _write_tables(folder)


def write_tables_now_and_then(folder: Path) -> None:
    """Write the tables of a sweep that is running, unless they are young for their size or somebody else is about it.

    Raises:
        OSError: the folder cannot be read or written.
    """
    if _age(folder) < LEAST_AGE:
        return
    with held_if_free(folder, TABLE) as free:
        if free:
            _write_tables(folder)


def without_empty_columns(table: Sequence[Sequence[Cell]]) -> list[list[Cell]]:
    """Give a table without the columns that hold nothing in any row."""
    filled = [any(cell not in (None, "") for cell in column[1:]) for column in zip(*table, strict=True)]
    return [[cell for cell, keep in zip(line, filled, strict=True) if keep] for line in table]


def _write_tables(folder: Path) -> tuple[SweepRow, ...]:
    rows = read_rows(folder)
    table = cells(rows)
    write_whole(folder / CSV, csv_text(table))
    write_whole(folder / LINES, "".join(json.dumps(row.record()) + "\n" for row in rows))
    write_whole(folder / MARKDOWN, markdown_text(without_empty_columns(table)))
    return rows


def _age(folder: Path) -> float:
    """Give for how long the tables have stood, s, less what their size entitles them to; without an end where there are none."""
    try:
        last = os.stat(folder / MARKDOWN).st_mtime, os.stat(folder / LINES).st_size
    except FileNotFoundError:
        return math.inf
    return time.time() - last[0] - last[1] * AGE_PER_BYTE


def _row(folder: Path, job: int) -> SweepRow:
    try:
        return read_job(folder / str(job)).row
    except (ValueError, OSError) as error:
        return SweepRow(job, (), UNREADABLE, str(error))
