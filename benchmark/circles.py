"""The largest equal circles in the unit square by the same engine, the radius as the score, against the best known packings.

python -m benchmark.circles
"""

import json
from pathlib import Path
from time import monotonic
from typing import Any

import multilens as ml
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

COUNTS = range(2, 18)

LIMIT = 10.0
"""s, for each number of circles."""

EXACT = 1e-9
"""By which a radius may differ from the published one."""

SEED = 0
"""Fixed before the first run."""

RESULTS = Path(__file__).parent / "results"
TRUTHS = Path(__file__).parents[1] / "tests" / "truths.json"


def packing(count: int) -> ml.ScoreProblem:
    """Give the question: of so many circles in the unit square, the smallest as large as can be."""
    lenses = [ml.Lens(1.0, (0.01, 0.5))] * count
    return ml.ScoreProblem(ml.Back.rectangle(1, 1), lenses, lambda layout: -layout.aperture_radius)


def published() -> dict[int, float]:
    """Give the best known radius for each number of circles, mm in a square of 1 mm."""
    table = json.loads(TRUTHS.read_text(encoding="utf-8"))["equal_circles_in_unit_square_radius"]
    return {count: table[str(count)] for count in COUNTS}


def row(count: int, radius: float, limit: float = LIMIT) -> list[Any]:
    """Give what the search finds for one number of circles: radius, how much it lacks, time, verdict."""
    began = monotonic()
    design = ml.solve(packing(count), seed=SEED, time_limit=limit)
    seconds = monotonic() - began
    lacks = radius + design.score if design.feasible else float("inf")
    return [count, radius, -design.score, lacks, round(seconds, 2), "pass" if lacks <= EXACT else "falls short"]


def circles_table(limit: float = LIMIT) -> list[list[Any]]:
    """Give a row for each number of circles, head first."""
    head = ["circles", "published radius", "found radius", "lacks", "time (s)", "verdict"]
    return [head, *(row(count, radius, limit) for count, radius in published().items())]


def main() -> None:
    """Run and write the table."""
    rows = circles_table()
    RESULTS.mkdir(exist_ok=True)
    write_whole(RESULTS / "circles.csv", csv_text(rows))
    write_whole(RESULTS / "circles.md", markdown_text(rows))
    print(markdown_text(rows))


if __name__ == "__main__":
    main()
