"""The page of a sweep: its charts, its layouts side by side and its table, linked job by job."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

from multilens.design import Design
from multilens.plot.page import layout_svg
from multilens.plot.sweep_groups import figure_of, in_words, questions, short_names, varied
from multilens.plot.units import significant
from multilens.report.charts import Chart, charts, is_number
from multilens.report.page import page
from multilens.report.table import NONE, Table
from multilens.report.tables import lens_table
from multilens.robust import as_drawn
from multilens.sweep_row import Cell, SweepRow, cells, column_of
from multilens.sweeps.table import without_empty_columns

MOST_JOBS, MOST_LAYOUTS, MOST_FAILED = 400, 96, 200
"""Jobs with a design, layouts and jobs without a design that are told: a page should open at once."""

MOST_PAIRS = 10_000
"""Pairs of lenses in all layouts together, a thin line each."""

WIDE, HIGH = 260.0, 340.0
"""Points across a layout, and the most it has in height."""


@dataclass(frozen=True)
class Card:
    """A job with its layout.

    Args:
        job: its number.
        words: what sets it apart from the others.
        figure: its error, with unit.
        facts: its other numbers, by name.
        layout: the picture.
        lenses: their table.
    """

    job: int
    words: str
    figure: str
    facts: Mapping[str, str]
    layout: str
    lenses: Table


def sweep_page(rows: Sequence[SweepRow], designs: Mapping[int, Design]) -> str:
    """Give the page of a sweep as HTML; the same rows and designs give the same bytes.

    Args:
        rows: of its table.
        designs: those that could be read, by job, of the rows that `worth_drawing` gives.

    Raises:
        ValueError: there are no rows.
    """
    if not rows:
        raise ValueError("sweep must have at least one job to be reported, got none")
    keys, told = varied(rows), worth_telling(rows)
    names = short_names(keys)

    def words(row: SweepRow) -> str:
        return f"job {row.job}: {', '.join(filter(None, [_settings(row, keys, names), figure_in_words(row)]))}"

    failed = [row for row in rows if row.figure is None]
    cards = [_card(row, designs[row.job], keys, names) for row in sorted(told, key=_job) if row.job in designs]
    drawn: list[Chart] = list(charts(sorted(told, key=_job), words))
    swept = f": {', '.join(names.values())}" if names else ""
    content: dict[str, Any] = {
        "title": f"Sweep of {len(rows)} job{'s' * (len(rows) > 1)}{swept}",
        "facts": _facts(rows, keys),
        "charts": drawn,
        "questions": list(dict.fromkeys(chart.question for chart in drawn)),
        "rights": list(dict.fromkeys(chart.right for chart in drawn)),
        "ups": list(dict.fromkeys(chart.up for chart in drawn)),
        "cards": cards,
        "best": _best_of_what_is_shown(told),
        "jobs": _table(sorted(told, key=_job), keys),
        "left_out": len(rows) - len(failed) - len(told),
        "without_layout": len(told) - len(cards),
        "failed": _failures(failed[:MOST_FAILED], keys, names),
        "failed_left_out": max(0, len(failed) - MOST_FAILED),
    }
    return page("sweep.html.j2", content)


def worth_telling(rows: Sequence[SweepRow]) -> tuple[SweepRow, ...]:
    """Give the rows with a design that the page tells, the least figure first: all, or as many as have room."""
    found = sorted((row for row in rows if row.figure is not None), key=lambda row: (figure_of(row), row.job))
    return tuple(found[:MOST_JOBS])


def worth_drawing(rows: Sequence[SweepRow]) -> tuple[SweepRow, ...]:
    """Give those of them whose layouts the page shows."""
    told = worth_telling(rows)[:MOST_LAYOUTS]
    pairs = accumulate((row.lens_count or 0) ** 2 // 2 for row in told)
    return tuple(row for row, so_far in zip(told, pairs, strict=True) if so_far <= MOST_PAIRS)


def figure_in_words(row: SweepRow) -> str:
    """Give the figure of a row with its name and unit; its status where it has none."""
    if row.figure is None:
        return row.status
    return f"{row.metric or 'score'} {significant(row.figure, 4)} {row.unit or ''}".strip()


def _best_of_what_is_shown(rows: Sequence[SweepRow]) -> int | None:
    """Give the best job of the question that the page opens with: figures of others may be in other units."""
    found = questions(sorted(rows, key=_job))[0].found if rows else ()
    return min(found, key=lambda row: (figure_of(row), row.job)).job if found else None


def _job(row: SweepRow) -> int:
    return row.job


def _settings(row: SweepRow, keys: Mapping[str, Any], names: Mapping[str, str]) -> str:
    return in_words(((key, value) for key, value in row.settings if key in keys), names)


def _facts(rows: Sequence[SweepRow], keys: Mapping[str, Any]) -> dict[str, str]:
    statuses = {row.status: sum(other.status == row.status for other in rows) for row in rows}
    facts = {"jobs": ", ".join(f"{count} {status}" for status, count in statuses.items())}
    facts |= {key: ", ".join(values) for key, values in keys.items()}
    same = dict.fromkeys((key, value) for row in rows for key, value in row.settings if key not in keys)
    if same:
        facts["the same in all"] = ", ".join(f"{key}={value}" for key, value in same)
    return facts


def _card(row: SweepRow, design: Design, keys: Mapping[str, Any], names: Mapping[str, str]) -> Card:
    problem, longest = as_drawn(design.problem), design.longest_baseline
    facts = {key: value for key, value in row.settings if key in keys} | {
        "status": row.status,
        "figure": figure_in_words(row),
    }
    facts |= {
        "RMSE": NONE if row.rmse is None else f"{significant(row.rmse, 4)} mm",
        "longest baseline": NONE if longest is None else f"{significant(longest[0], 4)} mm",
        "gap to the bound": NONE if row.gap is None else f"{100 * row.gap:.3g} % of the score",
        "apertures together": NONE if row.aperture_area is None else f"{significant(row.aperture_area, 4)} mm²",
    }
    if row.note:
        facts["note"] = row.note
    label = f"The back to scale with the {design.layout.count} lenses of job {row.job}."
    svg = layout_svg(problem, design.layout, f"job-{row.job}-layout", label, WIDE, HIGH)
    lenses = lens_table(problem, design.layout, f"job-{row.job}-lenses")
    return Card(row.job, _settings(row, keys, names), figure_in_words(row), facts, svg, lenses)


def _table(rows: Sequence[SweepRow], keys: Mapping[str, Any]) -> Table | None:
    if not rows:
        return None
    same = {column_of(key) for row in rows for key, _ in row.settings if key not in keys}
    head, *lines = without_empty_columns(cells(rows))
    kept = [k for k, name in enumerate(head) if name not in same]
    shown = tuple(tuple(_shown(line[k]) for k in kept) for line in lines)
    names = tuple(str(head[k]).replace("_", " ") for k in kept)
    words = tuple(
        k
        for k, column in enumerate(zip(*shown, strict=True))
        if not all(word == NONE or is_number(word) for word in column)
    )
    caption = "Every job that found a design. A head sorts; a row, a point and a layout lead to the same job."
    return Table("jobs", caption, names, shown, words)


def _failures(rows: Sequence[SweepRow], keys: Mapping[str, Any], names: Mapping[str, str]) -> Table | None:
    lines = tuple((str(row.job), _settings(row, keys, names), row.status, row.reason) for row in rows)
    caption = "Jobs without a design, and why."
    return Table("failed", caption, ("job", "settings", "status", "reason"), lines, (1, 2, 3)) if rows else None


def _shown(cell: Cell) -> str:
    return NONE if cell is None or cell == "" else f"{cell:.5g}" if isinstance(cell, float) else str(cell)
