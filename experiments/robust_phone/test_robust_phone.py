"""The study's result still holds: its stored designs on devices that no search has seen, and against what can be said by hand."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest

import multilens as ml
from multilens.robust import without

RESULTS = Path(__file__).parent / "results"
NAMES = ("assembly", "focus", "finger", "all")


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew, on the same devices.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def robust(design: ml.Design) -> ml.Robust:
    assert isinstance(design.problem, ml.Robust)
    return design.problem


def test_there_is_a_design_for_each_disturbance_and_one_for_none(designs: dict[str, ml.Design]) -> None:
    assert sorted(designs) == sorted([*NAMES, "nominal"])
    assert all(design.certificate.feasible for design in designs.values())


@pytest.mark.parametrize("name", NAMES)
def test_a_robust_design_is_better_on_devices_that_nobody_has_searched_with(
    designs: dict[str, ml.Design], name: str
) -> None:
    others = robust(designs[name]).afresh(seed=77, samples=256)
    assert others.score(designs[name].layout) < others.score(designs["nominal"].layout)


def test_the_table_shows_the_designs_on_other_devices(designs: dict[str, ml.Design]) -> None:
    with (RESULTS / "table.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for name, row in zip(NAMES, rows, strict=True):
        others = robust(designs[name]).afresh(seed=1, samples=1024)
        for column, design in (("nominal design (mm)", designs["nominal"]), ("robust design (mm)", designs[name])):
            figure = others.score(design.layout).item() ** 0.5
            assert float(row[column]) == pytest.approx(figure, abs=5e-4)


def test_against_a_finger_all_lenses_are_worth_the_same(designs: dict[str, ml.Design]) -> None:
    design = designs["finger"]
    problem, layout = robust(design).problem, design.layout
    left = [without(problem, i).score(layout.only([j for j in range(4) if j != i])).item() for i in range(4)]
    assert max(left) == pytest.approx(min(left), rel=0.01)
    assert max(left) == pytest.approx(design.score, rel=1e-12)


def test_what_drifts_makes_defocus_useless_far_away(designs: dict[str, ml.Design]) -> None:
    problem = robust(designs["all"]).drawn
    winners = {problem.measurements[k].cue for k in problem.winners(designs["all"].layout)[-100:].tolist()}
    assert winners == {"stereo"}


def test_without_its_disturbance_no_robust_design_is_better_than_the_nominal_one(designs: dict[str, ml.Design]) -> None:
    for name in NAMES:
        plain = replace(robust(designs[name]), disturbance=ml.Disturbance())
        assert plain.score(designs["nominal"].layout) <= plain.score(designs[name].layout) * (1 + 1e-9)
