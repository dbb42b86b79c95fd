"""The study's result still holds: its stored designs, their bounds, and one more camera at a time."""

import csv
from itertools import groupby, pairwise
from math import hypot
from pathlib import Path

import pytest
import torch

import multilens as ml
from multilens.design import SAME

RESULTS = Path(__file__).parent / "results"

ROUNDING = 1e-6
"""Part of a score by which neighbours in a sweep may differ: less is a matter of rounding."""

FARTHEST = hypot(76.73 - 26, 159.86 - 26) + 2 * (13 - 6.86 / (2 * 1.78) - 6.17)
"""Largest distance of two bodies in opposite corners of the whole back, mm."""


@pytest.fixture(scope="module")
def rows() -> list[dict[str, str]]:
    with (RESULTS / "table.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def series(rows: list[dict[str, str]]) -> dict[tuple[str, str], list[dict[str, str]]]:
    """Give the rows of each range of depths and back, the fewest cameras first."""
    return {key: list(each) for key, each in groupby(rows, key=lambda row: (row["depth"], row["back"]))}


def test_there_is_a_job_for_every_number_of_cameras(rows: list[dict[str, str]]) -> None:
    assert len(series(rows)) == 6
    for each in series(rows).values():
        assert [row["lenses.count"] for row in each] == [str(count) for count in range(1, 9)]


def test_the_table_shows_the_designs(rows: list[dict[str, str]], designs: dict[str, ml.Design]) -> None:
    assert {row["job"] for row in rows if row["figure"]} == designs.keys()
    for row in rows:
        if row["figure"]:
            assert float(row["score"]) == pytest.approx(designs[row["job"]].score, rel=SAME)
            assert int(row["lens_count"]) == designs[row["job"]].layout.count


def test_the_error_falls_or_stays_with_every_camera_or_the_row_says_why_not(rows: list[dict[str, str]]) -> None:
    for each in series(rows).values():
        for fewer, more in pairwise(each):
            if not more["score"]:
                assert more["reason"]
            elif fewer["score"] and float(more["score"]) > float(fewer["score"]) * (1 + ROUNDING):
                assert "with fewer lenses" in more["note"], more["job"]


def test_the_bound_is_never_above_the_error(rows: list[dict[str, str]]) -> None:
    assert all(row["bound"] for row in rows if row["score"])
    assert all(float(row["bound"]) <= float(row["score"]) for row in rows if row["score"])


def test_a_back_is_never_worse_than_the_island_that_is_a_part_of_it(rows: list[dict[str, str]]) -> None:
    every = series(rows)
    for depth in ("near", "far", "room"):
        back, island = (every[depth, f"iphone_15_pro_max{part}"] for part in ("", "_island"))
        for whole, part in zip(back, island, strict=True):
            assert not part["score"] or float(whole["score"]) <= float(part["score"]) * (1 + ROUNDING)


def test_two_cameras_on_the_whole_back_stand_as_far_apart_as_it_allows(
    rows: list[dict[str, str]], designs: dict[str, ml.Design]
) -> None:
    for row in rows:
        if row["back"] == "iphone_15_pro_max" and row["lenses.count"] == "2":
            assert torch.pdist(designs[row["job"]].layout.position).item() == pytest.approx(FARTHEST, abs=1e-4)


def test_no_focus_on_a_grid_is_better_for_a_single_camera(
    rows: list[dict[str, str]], designs: dict[str, ml.Design]
) -> None:
    for row in rows:
        if row["lenses.count"] == "1":
            design = designs[row["job"]]
            foci = torch.linspace(200, 5000, 4801).double()
            tried = ml.Layout(
                design.layout.position.expand(len(foci), 1, 2),
                torch.full((len(foci), 1), 6.86 / (2 * 1.78), dtype=torch.float64),
                foci.reshape(-1, 1, 1),
            )
            assert design.score <= design.problem.score(tried).min().item() * (1 + ROUNDING)
