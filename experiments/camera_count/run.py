"""Run the sweep of the study, keep its table, its pictures and its designs, and write the table to read.

python experiments/camera_count/run.py
"""

import shutil
from dataclasses import replace
from pathlib import Path

import multilens as ml
from multilens.app.command import run_command
from multilens.app.ending import DONE, NOTHING_FOUND
from multilens.storage import write_whole
from multilens.sweep_row import SweepRow
from multilens.sweeps.table import CSV, read_rows
from multilens.table_text import csv_text, markdown_text

HERE = Path(__file__).parent
RESULTS, SWEEP = HERE / "results", HERE.parents[1] / "sweeps" / HERE.name
"""Interrupted, the script goes on where it was when it is run again."""

DEPTHS = {"near": "0.2 to 0.6 m", "far": "2 to 5 m", "room": "0.2 to 5 m"}

BACKS = {"iphone_15_pro_max": "whole back", "iphone_15_pro_max_island": "camera island"}


def table(rows: tuple[SweepRow, ...]) -> list[list]:
    """Give the error of every number of cameras, what no layout is below, and what the last camera changed, a line for each."""
    head = ["depths", "where", "cameras", "RMSE (mm)", "no layout is below (mm)", "change by the last camera"]
    lines, before = [head], rows[0]
    for row in rows:
        settings = dict(row.settings)
        where = [DEPTHS[settings["depth"]], BACKS[settings["back"]], int(settings["lenses.count"])]
        if row.figure is None or row.score is None:
            lines.append([*where, row.status, None, None])
            continue
        bound = None if row.bound is None else row.figure * (row.bound / row.score) ** 0.5
        follows = before.job == row.job - 1 and row.settings[:-1] == before.settings[:-1]
        change = f"{100 * (row.figure / before.figure - 1):+.2g} %" if follows and before.figure else None
        lines.append([*where, row.figure, bound, change])
        before = row
    return lines


def main() -> None:
    code = run_command([f"experiment={HERE.name}", f"hydra.sweep.dir={SWEEP}"])
    assert code in (DONE, NOTHING_FOUND), f"the sweep ended with exit code {code}"
    RESULTS.mkdir(exist_ok=True)
    for picture in [*SWEEP.glob("*.png"), *SWEEP.glob("*.svg"), SWEEP / CSV]:
        shutil.copyfile(picture, RESULTS / picture.name)
    rows = read_rows(SWEEP)
    for row in rows:
        if row.figure is not None:
            design = ml.Design.load(SWEEP / str(row.job) / "design.json")
            # The history of the starts is the larger part of a file, and nothing here asks for it.
            replace(design, convergence=None).save(RESULTS / f"{row.job}.json")
    write_whole(RESULTS / "counts.csv", csv_text(table(rows)))
    write_whole(RESULTS / "counts.md", markdown_text(table(rows)))


if __name__ == "__main__":
    main()
