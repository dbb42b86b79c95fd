"""Run the sweep of the study, keep its table, its pictures and its designs, and write the tables to read.

python experiments/pareto_island/run.py
"""

import shutil
from dataclasses import replace
from pathlib import Path

import multilens as ml
from multilens.app.command import run_command
from multilens.app.ending import DONE, NOTHING_FOUND
from multilens.plot.sweep_front import COSTS, cheapest
from multilens.storage import write_whole
from multilens.sweep_row import SweepRow
from multilens.sweeps.table import CSV, read_rows
from multilens.table_text import csv_text, markdown_text

HERE = Path(__file__).parent
RESULTS, SWEEP = HERE / "results", HERE.parents[1] / "sweeps" / HERE.name
"""Interrupted, the script goes on where it was when it is run again."""

WIDTH, F_NUMBER, COUNT = "back.outline.width", "lenses.lens.f_number", "lenses.count"


def widest(row: SweepRow) -> str:
    """Give the widest aperture that a job allowed, as people write it: f/1.78."""
    return "f/" + dict(row.settings)[F_NUMBER].strip("[]").split(",")[0]


def errors(rows: tuple[SweepRow, ...]) -> list[list]:
    """Give the error of every job: a line for each island and aperture, a column for each number of cameras."""
    counts = sorted({dict(row.settings)[COUNT] for row in rows}, key=int)
    lines: dict[tuple[str, str], dict[str, str | float]] = {}
    for row in rows:
        settings = dict(row.settings)
        line = lines.setdefault((f"{settings[WIDTH]} mm", widest(row)), {})
        line[settings[COUNT]] = row.status if row.figure is None else row.figure
    head = ["island", "widest aperture", *(f"{count} cameras: RMSE (mm)" for count in counts)]
    return [head, *([*where, *(line.get(count) for count in counts)] for where, line in lines.items())]


def fronts(rows: tuple[SweepRow, ...]) -> list[list]:
    """Give what no other job beats in error and one cost, for each of the costs."""
    lines: list[list] = [["cost", "is", "RMSE (mm)", "island", "widest aperture", "cameras", "job"]]
    found = [row for row in rows if row.figure is not None]
    for cost in COSTS:
        for row in cheapest(found, cost):
            settings = dict(row.settings)
            where = [f"{settings[WIDTH]} mm", widest(row), settings[COUNT], row.job]
            lines.append([cost.words, cost.of(row), row.figure, *where])
    return lines


def main() -> None:
    code = run_command([f"experiment={HERE.name}", f"hydra.sweep.dir={SWEEP}"])
    assert code in (DONE, NOTHING_FOUND), f"the sweep ended with exit code {code}"
    RESULTS.mkdir(exist_ok=True)
    for kept in [*SWEEP.glob("*.png"), *SWEEP.glob("*.svg"), SWEEP / CSV]:
        shutil.copyfile(kept, RESULTS / kept.name)
    rows = read_rows(SWEEP)
    for row in rows:
        if row.figure is not None:
            design = ml.Design.load(SWEEP / str(row.job) / "design.json")
            # The history of the starts is the larger part of a file, and nothing here asks for it.
            replace(design, convergence=None).save(RESULTS / f"{row.job}.json")
    for name, table in {"errors": errors(rows), "fronts": fronts(rows)}.items():
        write_whole(RESULTS / f"{name}.csv", csv_text(table))
        write_whole(RESULTS / f"{name}.md", markdown_text(table))


if __name__ == "__main__":
    main()
