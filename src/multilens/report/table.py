"""A table as plain words: what a page shows and what tests read."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Cells to read.

    Args:
        name: id of the table on its page.
        caption: what it shows.
        head: of each column.
        rows: as many cells each; the first says what the row is about.
        words: indices of the columns that are read rather than compared, and so begin at the left.
    """

    name: str
    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: tuple[int, ...] = ()


NONE = "-"
"""Stands in a cell that has nothing to say."""
