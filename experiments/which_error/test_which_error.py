"""The study's result still holds: every stored design is the best of all by the metric that it was made for."""

import csv
from pathlib import Path

import pytest

import multilens as ml
from multilens.metrics import METRICS

RESULTS = Path(__file__).parent / "results"
MADE_FOR = ("mean_square", "relative", "inverse_depth", "worst_case", "worst_relative")


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def judged(design: ml.Design, by: ml.Design) -> float:
    assert by.problem.metric is not None
    return by.problem.metric.figure(by.problem.score(design.layout).item())


@pytest.mark.parametrize("metric", MADE_FOR)
def test_no_other_design_is_better_by_its_metric(designs: dict[str, ml.Design], metric: str):
    own = designs[f"{metric}_best"]
    assert all(own.figure <= judged(designs[f"{other}_best"], own) for other in MADE_FOR)


@pytest.mark.parametrize("metric", MADE_FOR)
def test_little_is_left_to_gain(designs: dict[str, ml.Design], metric: str):
    assert designs[f"{metric}_best"].gap < 0.05


def test_all_measurements_together_leave_a_third_less(designs: dict[str, ml.Design]):
    together, best = designs["mean_square_inverse_variance"], designs["mean_square_best"]
    assert 0.6 < together.rmse / best.rmse < 0.72


def test_the_table_is_of_the_designs(designs: dict[str, ml.Design]):
    with (RESULTS / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    columns = [name for name in rows[0] if "(" in name][:5]
    for row in rows:
        design = designs[row["asked for"].replace(", ", "_")]
        column = next(
            name for name in columns if name == f"{design.problem.metric.name} ({design.problem.metric.unit})"
        )
        assert float(row[column]) == pytest.approx(design.figure, rel=5e-4)


def test_every_metric_there_is_takes_part(designs: dict[str, ml.Design]):
    assert {type(design.problem.metric) for design in designs.values()} == set(METRICS.values())
