"""The study's result still holds: its stored designs against closed forms, published distances and brute force."""

import csv
from math import hypot
from pathlib import Path

import pytest
import torch

import multilens as ml

RESULTS = Path(__file__).parent / "results"


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def test_all_five_layouts_are_there_and_feasible(designs: dict[str, ml.Design]) -> None:
    assert sorted(designs) == ["apple", "back_3", "back_4", "island_3", "island_4"]
    assert all(design.certificate.feasible for design in designs.values())


def test_the_table_shows_the_designs(designs: dict[str, ml.Design]) -> None:
    with (RESULTS / "table.csv").open(encoding="utf-8") as file:
        shown = [float(row["RMSE (mm)"]) for row in csv.DictReader(file)]
    names = ["apple", "island_3", "island_4", "back_3", "back_4"]
    assert shown == [pytest.approx(designs[name].rmse, abs=5e-5) for name in names]


def test_more_room_and_more_lenses_are_better(designs: dict[str, ml.Design]) -> None:
    order = ["back_4", "back_3", "island_4", "island_3", "apple"]
    scores = [designs[name].score for name in order]
    assert scores == sorted(scores)


def test_the_order_of_the_layouts_is_proved(designs: dict[str, ml.Design]) -> None:
    # No layout of the worse question can score below its bound, which is above what the better one reaches.
    for better, worse in (
        ("island_4", "island_3"),
        ("island_3", "apple"),
        ("back_4", "back_3"),
        ("back_3", "island_4"),
    ):
        bound = designs[worse].bound
        assert bound is not None
        assert bound.value is not None
        assert designs[better].score < bound.value


def test_baselines_of_apples_places_are_the_published_ones(designs: dict[str, ml.Design]) -> None:
    distances = torch.pdist(designs["apple"].layout.position)
    assert sorted(round(distance, 2) for distance in distances.tolist()) == [19.24, 20.4, 20.4]


@pytest.mark.parametrize("name", ["back_3", "back_4"])
def test_the_outer_lenses_are_the_farthest_pair_of_the_back(designs: dict[str, ml.Design], name: str) -> None:
    body = 6.86 / (2 * 1.78) + 6.17
    farthest = hypot(76.73 - 26, 159.86 - 26) + 2 * (13 - body)
    assert torch.pdist(designs[name].layout.position).max().item() == pytest.approx(farthest, abs=1e-6)


def test_no_foci_on_a_grid_are_better_for_apples_places(designs: dict[str, ml.Design]) -> None:
    design = designs["apple"]
    assert isinstance(design.problem, ml.Problem)
    foci = torch.combinations(torch.linspace(2000, 5000, 41).double(), 3)
    count = len(foci)
    tried = ml.Layout(
        design.layout.position.expand(count, 3, 2), design.layout.aperture_radius.expand(count, 3), foci.unsqueeze(-1)
    )
    assert (
        design.score <= torch.cat([design.problem.score(tried[part]) for part in torch.arange(count).split(1000)]).min()
    )


def test_a_search_of_today_finds_apples_foci_again(designs: dict[str, ml.Design]) -> None:
    design = designs["apple"]
    assert ml.solve(design.problem, starts=16, patience=2).score <= design.score * (1 + 1e-4)
