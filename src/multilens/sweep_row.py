"""What came of one job of a sweep, as the numbers that its tables, its pictures and its agreement need."""

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

from multilens.fields import number, record, text, whole_number

UNREADABLE, FAILED = "unreadable", "failed"

Cell = str | int | float | None

COLUMN = {
    "rmse": "rmse_mm",
    "gap": "gap_to_bound",
    "longest_baseline": "longest_baseline_mm",
    "aperture_area": "aperture_area_mm2",
    "body_area": "body_area_mm2",
    "back_area": "back_area_mm2",
    "time": "time_s",
}
"""Columns that are not called as the fields of a row are, since a column says its unit."""


@dataclass(frozen=True)
class SweepRow:
    """What came of one job.

    Args:
        job: its number, which is the name of its folder.
        settings: the swept keys and their values, as they were written, in the order of the sweep.
        status: of its design, or "infeasible", "refused", "failed" (by a fault) or "unreadable".
        reason: why there is no design; empty where there is one.
        note: what a reader of the design should know, such as why it is worse than its neighbour's; mostly empty.
        lens_count: how many lenses; None without a design, like all that follows.
        metric: what was asked for, such as RMSE.
        figure: the score as the metric quotes it, in `unit`.
        unit: of the figure.
        score: in the square of that unit, or a fixed part of it.
        rmse: mm, whichever metric was asked for.
        measured: share of the depths at which anything measures.
        bound: below which no feasible layout scores, in the unit of the score; None where none is known.
        gap: to the bound, as a part of the score; None where no bound is known.
        longest_baseline: mm; None for a single lens.
        aperture_area: of all apertures together, sum of pi r^2, mm^2.
        body_area: of all bodies together, sum of pi (r + clearance)^2, mm^2.
        back_area: of the outline of the back, mm^2.
        time: that the search took, s.
    """

    job: int
    settings: tuple[tuple[str, str], ...]
    status: str
    reason: str = ""
    note: str = ""
    lens_count: int | None = None
    metric: str | None = None
    figure: float | None = None
    unit: str | None = None
    score: float | None = None
    rmse: float | None = None
    measured: float | None = None
    bound: float | None = None
    gap: float | None = None
    longest_baseline: float | None = None
    aperture_area: float | None = None
    body_area: float | None = None
    back_area: float | None = None
    time: float | None = None

    def record(self) -> dict[str, Any]:
        """Give the row as plain data, by the names of the columns; the settings are a record of their own."""
        plain = {COLUMN.get(name, name): value for name, value in asdict(self).items()}
        return plain | {"settings": dict(self.settings)}


NAMES = tuple(COLUMN.get(field.name, field.name) for field in fields(SweepRow))


def read_row(value: object, name: str) -> SweepRow:
    """Read what `SweepRow.record` gives.

    Args:
        value: as it was read from a file.
        name: path of the key from the top of the file.

    Raises:
        ValueError: a key is unknown or missing, or a value of the wrong type.
    """
    given = record(value, name, NAMES)
    settings = record(given["settings"], f"{name}.settings", (), optional=list(given["settings"] or ()))
    read: dict[str, Any] = {
        "job": whole_number(given["job"], f"{name}.job"),
        "settings": tuple((key, text(setting, f"{name}.settings.{key}")) for key, setting in settings.items()),
    }
    for field in fields(SweepRow)[2:]:
        column = COLUMN.get(field.name, field.name)
        read[field.name] = _read(field.type, given[column], f"{name}.{column}")
    return SweepRow(**read)


def cells(rows: Sequence[SweepRow]) -> list[list[Cell]]:
    """Give rows as a table: its head, with a column for every key that was swept, then a line for each row."""
    keys = list(dict.fromkeys(key for row in rows for key, _ in row.settings))
    after = [name for name in NAMES if name not in ("job", "settings")]
    lines = [(row.record(), dict(row.settings)) for row in rows]
    return [["job", *map(column_of, keys), *after]] + [
        [plain["job"], *(settings.get(key) for key in keys), *(plain[name] for name in after)]
        for plain, settings in lines
    ]


def column_of(key: str) -> str:
    """Give the name of a swept key's column: the key, with an equals sign where another column has that name."""
    return f"{key}=" if key in NAMES else key


def in_order(values: Iterable[str]) -> list[str]:
    """Give the values of a swept key, each once, in order: numbers by their size, words as they come."""
    named = list(dict.fromkeys(values))
    try:
        return sorted(named, key=float)
    except ValueError:
        return named


def _read(kind: Any, value: object, name: str) -> Cell:
    if value is None and kind is not str:
        return None
    if kind in (str, str | None):
        return text(value, name)
    return whole_number(value, name) if kind == int | None else number(value, name)
