"""Tables as text: comma-separated for programs, Markdown for people."""

import csv
from collections.abc import Iterable, Sequence
from io import StringIO
from typing import Any


def csv_text(rows: Iterable[Sequence[Any]]) -> str:
    """Give rows as comma-separated text; floats are written so that they read back bit for bit, None as nothing."""
    table = StringIO()
    csv.writer(table, lineterminator="\n").writerows(rows)
    return table.getvalue()


def markdown_text(cells: Sequence[Sequence[Any]]) -> str:
    """Give rows, the first of them the head, as a Markdown table; floats to 5 digits, None as nothing."""
    head, *rows = [[_shown(cell) for cell in row] for row in cells]
    return "".join(f"| {' | '.join(row)} |\n" for row in [head, ["---"] * len(head), *rows])


def _shown(cell: Any) -> str:
    shown = "" if cell is None else f"{cell:.5g}" if isinstance(cell, float) else str(cell)
    return shown.replace("|", "\\|").replace("\n", " ")
