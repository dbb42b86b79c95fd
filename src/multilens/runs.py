"""The run folder: everything about one design in one place, written whole or not at all, and drawn again from itself.

    config.yaml      what was asked, as it was resolved
    design.json      the design, which alone is enough for everything else
    layout.csv       a row for each lens
    sensitivity.csv  what it costs that one of them is off, where depths were asked for
    *.svg, *.png     its pictures
    run.log          what the run said
    overrides.json   what set this job of a sweep apart from the others, where it was one

A job that found nothing leaves failure.json in place of design, layout and pictures. A sweep is a folder of run folders, each
named by the number of its job, and gathers them in a table.
"""

import csv
import json
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import StringIO
from math import isnan
from pathlib import Path
from typing import Any

from multilens.constraints import body_radius
from multilens.design import Design
from multilens.documents import read_text
from multilens.fields import items, record, text
from multilens.storage import folder_written_whole, scratch_folder, write_whole

CONFIG, DESIGN, LAYOUT, LOG = "config.yaml", "design.json", "layout.csv", "run.log"
SENSITIVITY = "sensitivity.csv"
OVERRIDES, FAILURE = "overrides.json", "failure.json"
UNFINISHED, UNREADABLE = "unfinished", "unreadable"


@dataclass(frozen=True)
class SweepRow:
    """What came of one job.

    Args:
        job: its number, which is the name of its folder.
        overrides: `key=value` of what set it apart.
        status: of its design or its failure; "unfinished" for an empty folder, "unreadable" for a damaged one.
        reason: why there is no design; empty where there is one.
        lens_count: how many lenses; None without a design, like all that follows.
        metric: what was asked for, such as RMSE.
        figure: the score as the metric quotes it, in `unit`.
        unit: of the figure.
        score: in the square of that unit, or a fixed part of it.
        rmse: mm, whichever metric was asked for.
        measured: share of the depths at which anything measures.
        gap: to the lower bound, as a part of the score; None where no bound is known.
        longest_baseline: mm; None for a single lens.
    """

    job: int
    overrides: tuple[str, ...]
    status: str
    reason: str = ""
    lens_count: int | None = None
    metric: str | None = None
    figure: float | None = None
    unit: str | None = None
    score: float | None = None
    rmse: float | None = None
    measured: float | None = None
    gap: float | None = None
    longest_baseline: float | None = None


def write_run(folder: Path, design: Design, config_text: str, log_text: str, overrides: Sequence[str] = ()) -> None:
    """Write the folder of a run that found a design.

    Args:
        folder: where it goes; may be there already if it is empty. Its parent must exist.
        design: feasible.
        config_text: what was asked, as it was resolved.
        log_text: what the run said.
        overrides: `key=value` of everything that sets a job of a sweep apart; none for a run of its own.

    Raises:
        ValueError: the design is infeasible.
        TypeError: its problem has a score or a cue of one's own.
        FileExistsError: something is in the folder already.
        OSError: it cannot be written, or the disk is full; nothing is left behind then.
    """
    design_text = design.to_json()
    with folder_written_whole(folder) as inside:
        (inside / DESIGN).write_text(design_text, encoding="utf-8", newline="\n")
        (inside / LAYOUT).write_text(layout_csv(design), encoding="utf-8", newline="\n")
        (inside / SENSITIVITY).write_text(csv_text(design.sensitivity().cells()), encoding="utf-8", newline="\n")
        _write_common(inside, config_text, log_text, overrides)
        _draw(design, inside)


def write_failure(
    folder: Path, status: str, reason: str, config_text: str, log_text: str, overrides: Sequence[str] = ()
) -> None:
    """Write the folder of a job that found nothing, so that a table of the sweep can say so.

    Args:
        folder: where it goes; may be there already if it is empty. Its parent must exist.
        status: what it came to, such as "infeasible".
        reason: why, in one line.
        config_text: what was asked, as it was resolved.
        log_text: what the run said.
        overrides: `key=value` of everything that sets the job apart.

    Raises:
        FileExistsError: something is in the folder already.
        OSError: it cannot be written, or the disk is full; nothing is left behind then.
    """
    failure = {"status": status, "reason": reason}
    with folder_written_whole(folder) as inside:
        (inside / FAILURE).write_text(json.dumps(failure, indent=2) + "\n", encoding="utf-8", newline="\n")
        _write_common(inside, config_text, log_text, overrides)


def redraw(folder: Path) -> None:
    """Draw the pictures of a run again from its saved design alone; nothing else is touched.

    Args:
        folder: of a run.

    Raises:
        ValueError: design.json is damaged; the file is named.
        OSError: there is no design.json, or the pictures cannot be written; those that were there stay then.
    """
    folder = folder.resolve()
    design = Design.load(folder / DESIGN)
    with scratch_folder(folder) as drawn:
        _draw(design, drawn)
        for picture in sorted(drawn.iterdir()):
            os.replace(picture, folder / picture.name)


def sweep_table(folder: Path) -> tuple[SweepRow, ...]:
    """Gather the rows of a sweep from the job folders in it, those named by a number, in the order of the numbers.

    A damaged job does not keep the others from the table; its row says what is wrong with it.

    Raises:
        OSError: the folder cannot be read.
    """
    jobs = [job for job in folder.iterdir() if job.is_dir() and re.fullmatch("[0-9]{1,18}", job.name)]
    return tuple(_row(job) for job in sorted(jobs, key=lambda job: int(job.name)))


def write_sweep_table(folder: Path) -> tuple[SweepRow, ...]:
    """Write the table of a sweep into its folder, table.csv for programs and table.md for people, each whole; give its rows.

    Raises:
        OSError: the folder cannot be read or written.
    """
    rows = sweep_table(folder)
    write_whole(folder / "table.csv", csv_text(_cells(rows)))
    write_whole(folder / "table.md", markdown_text(_cells(rows)))
    return rows


def layout_csv(design: Design) -> str:
    """Give the layout as a table: a row for each lens, in the units that the head of each column names."""
    head = (
        "lens",
        "x_mm",
        "y_mm",
        "aperture_radius_mm",
        "f_number",
        "focus_mm",
        "body_radius_mm",
        "focal_length_mm",
    )
    layout, lenses = design.layout, design.problem.lenses
    columns = zip(
        layout.position.tolist(),
        layout.aperture_radius.tolist(),
        design.f_numbers,
        design.foci,
        body_radius(layout, lenses).tolist(),
        lenses,
        strict=True,
    )
    rows = [
        (i + 1, x, y, radius, f_number, ";".join(map(repr, foci)), body, float(lens.focal_length))
        for i, ((x, y), radius, f_number, foci, body, lens) in enumerate(columns)
    ]
    return csv_text([head, *rows])


def csv_text(rows: Iterable[Sequence[Any]]) -> str:
    """Give rows as comma-separated text; floats are written so that they read back bit for bit, None as nothing."""
    table = StringIO()
    csv.writer(table, lineterminator="\n").writerows(rows)
    return table.getvalue()


def _write_common(inside: Path, config_text: str, log_text: str, overrides: Sequence[str]) -> None:
    (inside / CONFIG).write_text(config_text, encoding="utf-8", newline="\n")
    (inside / LOG).write_text(log_text, encoding="utf-8", newline="\n")
    if overrides:
        (inside / OVERRIDES).write_text(json.dumps(list(overrides)) + "\n", encoding="utf-8", newline="\n")


def _draw(design: Design, folder: Path) -> None:
    # Loaded only where something is drawn: it costs a second.
    from multilens.plot.figures import design_figures, overview_figure, save_figures

    figures = design_figures(design.problem, design.layout, design.convergence, design.tolerance)
    overview = overview_figure(design.problem, design.layout, design.tolerance)
    save_figures(figures | {"overview": overview}, folder)


def _row(folder: Path) -> SweepRow:
    job, overrides = int(folder.name), ()
    try:
        overrides = _overrides(folder)
        if (folder / DESIGN).exists():
            design = Design.load(folder / DESIGN)
            longest = design.longest_baseline
            baseline = None if longest is None else longest[0]
            gap = None if isnan(design.gap) else design.gap
            metric = design.problem.metric
            name, unit = (None, None) if metric is None else (metric.name, metric.unit)
            found = (
                design.layout.count,
                name,
                design.figure,
                unit,
                design.score,
                design.rmse,
                design.measured,
                gap,
                baseline,
            )
            return SweepRow(job, overrides, design.status, "", *found)
        if (folder / FAILURE).exists():
            failure = record(_json(folder / FAILURE), FAILURE, ("status", "reason"))
            return SweepRow(job, overrides, text(failure["status"], "status"), text(failure["reason"], "reason"))
    except (ValueError, OSError) as error:
        return SweepRow(job, overrides, UNREADABLE, str(error))
    return SweepRow(job, overrides, UNFINISHED, "the job left nothing")


def _overrides(folder: Path) -> tuple[str, ...]:
    path = folder / OVERRIDES
    if not path.exists():
        return ()
    return tuple(text(item, f"{OVERRIDES}[{index}]") for index, item in enumerate(items(_json(path), OVERRIDES)))


def _json(path: Path) -> Any:
    try:
        return json.loads(read_text(path))
    except (ValueError, RecursionError):
        raise ValueError(f"{path} must be whole JSON") from None


def _cells(rows: Sequence[SweepRow]) -> list[list[Any]]:
    """Give the head and the rows, with a column for every key that was swept."""
    settings = [{key: value for key, _, value in (each.partition("=") for each in row.overrides)} for row in rows]
    keys = list(dict.fromkeys(key for setting in settings for key in setting))
    head = [
        "job",
        *keys,
        "lens_count",
        "status",
        "metric",
        "figure",
        "unit",
        "score",
        "rmse_mm",
        "measured",
        "gap_to_bound",
        "longest_baseline_mm",
        "reason",
    ]
    return [head] + [
        [
            row.job,
            *(setting.get(key) for key in keys),
            row.lens_count,
            row.status,
            row.metric,
            row.figure,
            row.unit,
            row.score,
            row.rmse,
            row.measured,
            row.gap,
            row.longest_baseline,
            row.reason,
        ]
        for row, setting in zip(rows, settings, strict=True)
    ]


def markdown_text(cells: Sequence[Sequence[Any]]) -> str:
    """Give rows, the first of them the head, as a Markdown table; floats to 5 digits, None as nothing."""
    head, *rows = [[_shown(cell) for cell in row] for row in cells]
    return "".join(f"| {' | '.join(row)} |\n" for row in [head, ["---"] * len(head), *rows])


def _shown(cell: Any) -> str:
    shown = "" if cell is None else f"{cell:.5g}" if isinstance(cell, float) else str(cell)
    return shown.replace("|", "\\|").replace("\n", " ")
