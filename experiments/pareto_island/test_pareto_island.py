"""The study's result still holds: its stored designs, their bounds, and what no other job beats."""

import csv
from itertools import product
from pathlib import Path

import pytest

import multilens as ml
from multilens.design import SAME

RESULTS = Path(__file__).parent / "results"

WIDTHS, APERTURES, COUNTS = ("34", "42", "50", "58"), ("[1.78,11]", "[2.8,11]", "[4,11]"), ("2", "3", "4", "5")

ROUNDING = 1e-6
"""Part of a score by which neighbours in a sweep may differ: less is a matter of rounding."""

Key = tuple[str, ...]


@pytest.fixture(scope="module")
def rows() -> dict[Key, dict[str, str]]:
    with (RESULTS / "table.csv").open(encoding="utf-8", newline="") as file:
        return {
            (row["back.outline.width"], row["lenses.lens.f_number"], row["lenses.count"]): row
            for row in csv.DictReader(file)
        }


def before(key: Key, axis: int, values: tuple[str, ...]) -> Key | None:
    """Give the key with the value before in one of its three parts."""
    k = values.index(key[axis])
    return None if k == 0 else tuple(values[k - 1] if part == axis else own for part, own in enumerate(key))


def test_there_is_a_job_for_every_combination(rows: dict[Key, dict[str, str]]) -> None:
    assert set(rows) == set(product(WIDTHS, APERTURES, COUNTS))


def test_the_table_shows_the_designs(rows: dict[Key, dict[str, str]]) -> None:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    designs = {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}
    assert {row["job"] for row in rows.values() if row["score"]} == designs.keys()
    for key, row in rows.items():
        if row["score"]:
            design = designs[row["job"]]
            assert float(row["score"]) == pytest.approx(design.score, rel=SAME)
            assert design.problem.back.outline.bounds[2] - design.problem.back.outline.bounds[0] == float(key[0])
            assert min(design.f_numbers) >= float(key[1].strip("[]").split(",")[0]) - 1e-9


def test_the_bound_is_never_above_the_error(rows: dict[Key, dict[str, str]]) -> None:
    assert all(float(row["bound"]) <= float(row["score"]) for row in rows.values() if row["score"])


@pytest.mark.parametrize(("axis", "values"), [(0, WIDTHS), (1, APERTURES[::-1])])
def test_more_room_or_a_wider_aperture_is_never_worse(
    rows: dict[Key, dict[str, str]], axis: int, values: tuple[str, ...]
) -> None:
    # Stopping down forbids what was allowed before, and a smaller island lies in a larger one.
    for key, row in rows.items():
        less = before(key, axis, values)
        if less is not None and rows[less]["score"]:
            assert float(row["score"]) <= float(rows[less]["score"]) * (1 + ROUNDING), key


def test_a_camera_more_is_never_worse_or_the_row_says_why(rows: dict[Key, dict[str, str]]) -> None:
    for key, row in rows.items():
        fewer = before(key, 2, COUNTS)
        if fewer is None:
            continue
        if not row["score"]:
            assert row["reason"]
        elif rows[fewer]["score"] and float(row["score"]) > float(rows[fewer]["score"]) * (1 + ROUNDING):
            assert "with fewer lenses" in row["note"], key


def test_the_fronts_hold_what_no_job_beats(rows: dict[Key, dict[str, str]]) -> None:
    with (RESULTS / "fronts.csv").open(encoding="utf-8", newline="") as file:
        shown = list(csv.DictReader(file))
    columns = {
        "area of the back": "back_area_mm2",
        "area of all apertures": "aperture_area_mm2",
        "lenses": "lens_count",
    }
    for words, column in columns.items():
        points = {row["job"]: (float(row[column]), float(row["figure"])) for row in rows.values() if row["figure"]}
        for line in (line for line in shown if line["cost"].startswith(words)):
            cost, error = points[line["job"]]
            # Six digits count, so that rounding makes no front.
            assert not any(a <= cost * (1 - 1e-5) and b <= error * (1 - 1e-5) for a, b in points.values())
