"""The study's result still holds: its stored layouts against published distances, proofs and today's evaluation."""

import csv
from math import pi
from pathlib import Path

import pytest
import torch

import multilens as ml

RESULTS = Path(__file__).parent / "results"
PHONES = [path.stem for path in sorted(RESULTS.glob("*.json")) if (RESULTS / f"{path.stem}_best.json").exists()]
APPLE = [[14.17, 14.17], [14.17, 33.41], [32.16, 23.79]]


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def table(name: str) -> list[dict[str, str]]:
    with (RESULTS / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_all_ten_phones_are_there() -> None:
    assert len(PHONES) == len(table("phones")) == 10


@pytest.mark.parametrize(
    ("phone", "baselines"),
    [
        ("iphone_13_pro", [17.92, 18.91, 18.91]),
        ("iphone_15_pro_max", [19.24, 20.40, 20.40]),
        ("pixel_4", [13.0]),
    ],
)
def test_where_distances_are_published_the_phone_has_them(
    designs: dict[str, ml.Design], phone: str, baselines: list[float]
) -> None:
    apart = torch.pdist(designs[phone].layout.position)
    assert sorted(round(distance, 2) for distance in apart.tolist()) == baselines


@pytest.mark.parametrize("phone", PHONES)
def test_the_best_layout_has_the_same_lenses(designs: dict[str, ml.Design], phone: str) -> None:
    def hardware(design: ml.Design) -> list[tuple[object, ...]]:
        return [(lens.focal_length, lens.aperture_radius, lens.clearance) for lens in design.problem.lenses]

    assert hardware(designs[phone]) == hardware(designs[f"{phone}_best"])


@pytest.mark.parametrize("phone", PHONES)
def test_the_best_layout_is_no_worse_and_close_to_its_bound(designs: dict[str, ml.Design], phone: str) -> None:
    best = designs[f"{phone}_best"]
    assert best.score <= designs[phone].score
    assert best.gap < 0.02


def test_the_tables_show_the_designs(designs: dict[str, ml.Design]) -> None:
    shown = {row["phone"]: float(row["RMSE as shipped (mm)"].split()[0]) for row in table("phones")}
    assert shown["iPhone 13 Pro"] == pytest.approx(designs["iphone_13_pro"].rmse, abs=5e-3)
    assert shown["Galaxy S23"] == pytest.approx(designs["galaxy_s23"].rmse, abs=5e-3)


@pytest.mark.parametrize("where", ["island", "back"])
def test_a_phone_that_is_extended_keeps_apples_places(designs: dict[str, ml.Design], where: str) -> None:
    for added in (1, 2):
        design = designs[f"extended_{where}_{added}"]
        assert design.feasible
        assert design.layout.position[:3].tolist() == APPLE


@pytest.mark.parametrize("where", ["island", "back"])
def test_each_camera_more_is_proved_to_help(designs: dict[str, ml.Design], where: str) -> None:
    one, two = (designs[f"extended_{where}_{added}"] for added in (1, 2))
    assert one.score < designs["iphone_15_pro_max"].score
    assert one.bound is not None
    assert one.bound.value is not None
    assert two.score < one.bound.value


def test_gains_for_each_mm2_are_those_of_the_bodies(designs: dict[str, ml.Design]) -> None:
    rows = {(row["new cameras on the"], row["added"]): row for row in table("extension")}
    before = designs["iphone_15_pro_max"].rmse
    # The small body is 1.90 + 2.60 mm in radius, Apple's shroud 16.20 mm across.
    for where, radius in (("island", 6.765 / (2 * 1.78) + 2.6), ("back", 8.1)):
        gain = before - designs[f"extended_{where}_1"].rmse
        assert float(rows[where, "1"]["per mm^2 of body (mm)"]) == pytest.approx(gain / (pi * radius**2), abs=1e-5)


def test_an_evaluation_of_today_finds_the_same(designs: dict[str, ml.Design]) -> None:
    design = designs["pixel_7"]
    assert isinstance(design.problem, ml.Problem)
    assert ml.evaluate(design.problem).score <= design.score * (1 + 1e-6)


@pytest.mark.parametrize("phone", PHONES)
def test_by_texture_and_noise_the_best_layout_is_no_worse(designs: dict[str, ml.Design], phone: str) -> None:
    best = designs[f"{phone}_photometric"]
    assert isinstance(best.problem, ml.Problem)
    assert best.problem.score(designs[phone].layout).item() >= best.score * (1 - 1e-9)


def test_the_photometric_table_shows_the_designs(designs: dict[str, ml.Design]) -> None:
    shown = {row["phone"]: float(row["relative RMSE, best (%)"]) for row in table("photometric")}
    assert shown["iPhone 13 Pro"] == pytest.approx(designs["iphone_13_pro_photometric"].figure, rel=5e-3)
    assert shown["Galaxy S23 Ultra"] == pytest.approx(designs["galaxy_s23_ultra_photometric"].figure, rel=5e-3)
