"""The study's result still holds: its stored designs reach the goal, and what is proved to be too little is so again."""

import csv
from math import hypot
from pathlib import Path

import pytest

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.inverse.resource import BackSize, WidestAperture

RESULTS = Path(__file__).parent / "results"
GOAL = 5.0
COUNTS = (2, 3, 4)


def table(name: str) -> list[dict[str, str]]:
    with (RESULTS / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def island(count: int) -> ml.Problem:
    return build_problem(read_given(["experiment=phone_back_island", f"lenses.count={count}"]).config)


@pytest.mark.parametrize("kind", ["size", "aperture"])
@pytest.mark.parametrize("count", COUNTS)
def test_what_is_enough_is_shown_by_a_design(kind: str, count: int) -> None:
    # Loading proves it feasible in exact arithmetic and derives its score anew.
    design = ml.Design.load(RESULTS / f"{kind}_{count}.json")
    assert design.rmse <= GOAL
    assert design.layout.count == count


@pytest.mark.parametrize("row", table("least"), ids=lambda row: row["lenses"])
def test_the_designs_are_as_small_as_the_table_says(row: dict[str, str]) -> None:
    count = row["lenses"]
    left, _, right, _ = ml.Design.load(RESULTS / f"size_{count}.json").problem.back.outline.bounds
    assert (right - left) / 45 == pytest.approx(float(row["size: enough"]), rel=1e-9)
    radii = ml.Design.load(RESULTS / f"aperture_{count}.json").layout.aperture_radius
    assert radii.max().item() <= float(row["aperture radius: enough (mm)"])


@pytest.mark.parametrize("row", table("least"), ids=lambda row: row["lenses"])
def test_what_is_too_little_is_proved_again(row: dict[str, str]) -> None:
    problem = island(int(row["lenses"]))
    small = BackSize(problem).with_only(float(row["size: proved too small"]))
    narrow = WidestAperture(problem).with_only(float(row["aperture radius: proved too small (mm)"]))
    for less in (small, narrow):
        bound = ml.lower_bound(less, 4000, GOAL**2 * 1.0003)
        assert bound.proves_that_nothing_fits or (bound.value or 0) ** 0.5 > GOAL


def test_more_lenses_need_narrower_apertures() -> None:
    enough = [float(row["aperture radius: enough (mm)"]) for row in table("least")]
    assert enough == sorted(enough, reverse=True)


def test_what_the_counted_lenses_reach_lies_above_what_none_is_below() -> None:
    for row in table("counts"):
        assert float(row["no layout is below (mm)"]) <= float(row["RMSE found (mm)"])


def test_one_lens_reaches_what_its_best_focus_does() -> None:
    depths, weights = island(1).depths, island(1).weights
    focus = (weights * depths**3).sum() / (weights * depths**2).sum()
    noise = 0.000244 / (2 * 6.86 / (2 * 1.78) * 6.86)
    error = noise * (weights * (depths * (depths - focus)) ** 2).sum().sqrt()
    assert float(table("counts")[0]["RMSE found (mm)"]) == pytest.approx(error.item(), rel=1e-6)


def test_a_tolerance_that_two_lenses_cannot_keep_is_the_widest_pair_and_two_foci() -> None:
    # The longest baseline that the island's rounded rectangle allows, 45 x 46 mm with corners of 12 mm, to smaller bodies than the
    # smallest: no pair is wider, so stereo keeps 10 mm no farther than sqrt(10 b f / n).
    widest = hypot(45 - 24, 46 - 24) + 2 * (12 - 6.17)
    stereo = (10 * widest * 6.86 / 0.000244) ** 0.5
    # Beyond, each focus keeps Z |Z - Zf| <= 10 * 2 A f / n: about q / Z to either side.
    q = 10 * 2 * 6.86 / (2 * 1.78) * 6.86 / 0.000244
    assert stereo + 2 * 2 * q / stereo < 5000
    (row,) = (row for row in table("tolerances") if row["tolerance at every depth"] == "10 mm")
    assert int(float(row["proved too few"])) >= 2
