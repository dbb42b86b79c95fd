"""The study's result still holds: its stored designs against a floor, brute force and hand-worked numbers."""

import csv
from math import hypot
from pathlib import Path

import pytest
import torch

import multilens as ml
from multilens.coverage import coverage

RESULTS = Path(__file__).parent / "results"

COUNTS = (2, 3, 4, 5)

METRICS = ("mean_square", "relative")

PARALLAX, NOISE = 0.738 / 6.86, 0.000244 / 6.86

FARTHEST = hypot(76.73 - 26, 159.86 - 26) + 2 * (13 - 6.86 / (2 * 1.78) - 6.17)
"""Largest distance of two bodies in opposite corners of the back, mm."""


def floor_error(depths: torch.Tensor) -> torch.Tensor:
    """Error at each depth of a pair as wide as may be used there, mm."""
    return depths**2 * NOISE / (PARALLAX * depths).clamp(max=FARTHEST)


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def problem_of(design: ml.Design) -> ml.Problem:
    assert isinstance(design.problem, ml.Problem)
    return design.problem


def on_a_line(*places: torch.Tensor) -> ml.Layout:
    """Many layouts whose lenses stand in one line, at places [b] from its beginning."""
    along = torch.stack([torch.zeros_like(places[0]), *places], dim=-1)
    position = torch.stack([along, torch.zeros_like(along)], dim=-1)
    return ml.Layout(position, torch.full_like(along, 1.9), torch.full_like(along, 1000.0))


def test_the_table_shows_the_designs(designs: dict[str, ml.Design]) -> None:
    with (RESULTS / "table.csv").open(encoding="utf-8") as file:
        shown = [float(row["with limits"]) for row in csv.DictReader(file)]
    names = [f"{metric}_{count}" for metric in METRICS for count in COUNTS]
    assert shown == [pytest.approx(designs[name].figure, rel=1e-3) for name in names]


def test_every_depth_is_measured(designs: dict[str, ml.Design]) -> None:
    assert all(design.measured == pytest.approx(1) for design in designs.values())


def test_more_than_two_lenses_pay_in_stereo_too(designs: dict[str, ml.Design]) -> None:
    two, three, four, five = (designs[f"relative_{count}"].figure for count in COUNTS)
    assert three < 0.3 * two
    assert four < 0.75 * three
    assert five < 0.97 * four


def test_without_limits_they_do_not(designs: dict[str, ml.Design]) -> None:
    # The two lenses farthest apart measure best at every depth: err / Z = Z delta / b.
    with (RESULTS / "table.csv").open(encoding="utf-8") as file:
        free = [float(row["without limits"]) for row in csv.DictReader(file) if row["minimised"].startswith("relative")]
    depths = problem_of(designs["relative_2"]).depths
    alone = 100 * (depths * NOISE / FARTHEST).square().mean().sqrt().item()
    assert free == [pytest.approx(alone, rel=1e-3)] * len(COUNTS)


def test_no_design_is_below_the_floor_at_any_depth(designs: dict[str, ml.Design]) -> None:
    for metric in METRICS:
        for count in COUNTS:
            design = designs[f"{metric}_{count}"]
            problem = problem_of(design)
            error = problem.errors(design.layout).amin(-2)
            assert (error >= floor_error(problem.depths) * (1 - 1e-9)).all()


@pytest.mark.parametrize(("metric", "above"), [("mean_square", 1.01), ("relative", 1.05)])
def test_five_lenses_are_nearly_at_the_floor(designs: dict[str, ml.Design], metric: str, above: float) -> None:
    design = designs[f"{metric}_5"]
    depths = problem_of(design).depths
    unit = depths / 100 if metric == "relative" else torch.ones_like(depths)
    assert design.figure < above * (floor_error(depths) / unit).square().mean().sqrt().item()


@pytest.mark.parametrize("metric", METRICS)
def test_no_pair_of_any_baseline_is_much_better_than_two_lenses(designs: dict[str, ml.Design], metric: str) -> None:
    design = designs[f"{metric}_2"]
    every = torch.linspace(1, FARTHEST, 2000, dtype=torch.float64)
    best = problem_of(design).score(on_a_line(every)).min()
    # The search's limit is smooth: it keeps a little away from the sharp one.
    assert design.score < 1.01 * best.item()


@pytest.mark.parametrize("metric", METRICS)
def test_no_three_in_a_line_are_much_better_than_three_lenses(designs: dict[str, ml.Design], metric: str) -> None:
    # All three baselines count, whose largest values a line has: a triangle has none that a line lacks.
    design = designs[f"{metric}_3"]
    first, second = (
        axis.flatten()
        for axis in torch.meshgrid(
            torch.linspace(5, 60, 111).double(), torch.linspace(60, FARTHEST, 187).double(), indexing="ij"
        )
    )
    scores = torch.cat(
        [problem_of(design).score(on_a_line(*part)) for part in zip(first.split(4096), second.split(4096), strict=True)]
    )
    assert design.score < 1.02 * scores.min().item()


def test_two_lenses_stand_as_far_apart_as_the_nearest_depth_allows(designs: dict[str, ml.Design]) -> None:
    baseline = torch.pdist(designs["mean_square_2"].layout.position).item()
    assert 0.995 * PARALLAX * 200 < baseline <= PARALLAX * 200


def test_wider_pairs_serve_farther_depths(designs: dict[str, ml.Design]) -> None:
    with (RESULTS / "served.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for count in COUNTS:
        baselines = [float(row["baseline (mm)"]) for row in rows if int(row["lenses"]) == count]
        assert baselines == sorted(baselines)


def test_the_effective_noise_of_unlike_lenses_is_that_worked_by_hand(designs: dict[str, ml.Design]) -> None:
    problem = problem_of(designs["wide_ultrawide_tele"])
    layout = ml.Layout([[0, 0], [20, 0], [10, 0]], [1.9, 0.5, 1.6], [1000, 1000, 1000])
    errors = ml.PairStereo()(layout, problem.lenses, torch.tensor([1000.0], dtype=torch.float64)).squeeze(-1)
    # Angles of 35.57, 126.13 and 22.22 microradians: root mean squares of 92.67, 29.66 and 90.56, times 1 m^2 over the baseline.
    assert errors.tolist() == pytest.approx([4.633, 2.966, 9.056], rel=1e-3)


def test_the_tele_lens_measures_the_centre_alone(designs: dict[str, ml.Design]) -> None:
    design = designs["wide_ultrawide_tele"]
    covers = coverage(problem_of(design), design.layout)
    # (tan 15.7 / tan 42.05)^2 of the image is 9.7 %: one ring of eight.
    assert problem_of(design).parts[0].share == 1 / 8
    assert 0 < sum(cover.share for cover in covers if 2 in cover.measurement.lenses) <= 1 / 8


def test_a_search_of_today_finds_three_lenses_again(designs: dict[str, ml.Design]) -> None:
    design = designs["relative_3"]
    found = ml.solve(problem_of(design), starts=16, patience=2, proof=0)
    assert found.figure <= design.figure * 1.02
