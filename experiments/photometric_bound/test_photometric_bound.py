"""The study's result still holds: bounds against stored and fresh simulations, designs against each other."""

import csv
from pathlib import Path
from types import ModuleType

import pytest
import torch

import multilens as ml

STUDY = Path(__file__).parent
RESULTS = STUDY / "results"

MODULES = ("simulate", "cases")
"""Of the study, in the order of their imports."""


@pytest.fixture(scope="module")
def simulate(study: dict[str, ModuleType]) -> ModuleType:
    return study["simulate"]


@pytest.fixture(scope="module")
def cases(study: dict[str, ModuleType]) -> ModuleType:
    return study["cases"]


def table(name: str) -> list[dict[str, str]]:
    with (RESULTS / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def designs() -> dict[str, ml.Design]:
    # Loading proves each one feasible in exact arithmetic and derives its score anew.
    return {path.stem: ml.Design.load(path) for path in RESULTS.glob("*.json")}


def test_the_stored_images_err_by_the_bounds_within_one_and_a_half_percent(
    cases: ModuleType, simulate: ModuleType
) -> None:
    depths = torch.tensor(cases.DEPTHS, dtype=torch.float64)
    for cue, bound in (("defocus", cases.defocus_bound), ("stereo", cases.stereo_bound)):
        stored = [float(row[f"{cue}: noisy images (mm)"]) for row in table("bound")]
        assert stored == pytest.approx(bound(simulate.Camera(), depths).tolist(), rel=0.015)


@pytest.mark.parametrize("depth", [500.0, 1500.0])
def test_fresh_images_err_by_the_bounds(cases: ModuleType, simulate: ModuleType, depth: float) -> None:
    camera, random = simulate.Camera(), torch.Generator().manual_seed(1)
    z = torch.tensor([depth], dtype=torch.float64)
    # A standard deviation of 10,000 numbers is off by 1 part in 140.
    found = simulate.defocus_error(camera, depth, 10_000, random)
    assert found == pytest.approx(cases.defocus_bound(camera, z).item(), rel=0.03)
    found = simulate.stereo_error(camera, depth, cases.BASELINE, 10_000, random)
    assert found == pytest.approx(cases.stereo_bound(camera, z).item(), rel=0.03)


def test_stereo_across_the_island_beats_defocus_in_every_light_and_at_every_aperture() -> None:
    seen = [row for row in table("phone") if row["defocus: at 1 m (mm)"] != "-"]
    assert len(seen) > 8
    assert all(float(row["stereo: at 1 m (mm)"]) < float(row["defocus: at 1 m (mm)"]) for row in seen)


def test_a_design_by_texture_light_and_noise_measures_at_every_depth(designs: dict[str, ml.Design]) -> None:
    assert designs["photometric"].measured == pytest.approx(1)


def test_such_a_design_beats_wide_open_lenses_and_the_thesis_design(designs: dict[str, ml.Design]) -> None:
    problem = designs["photometric"].problem
    assert isinstance(problem, ml.Problem)
    scores = [problem.score(designs[name].layout).item() for name in ("photometric", "wide_open", "thesis")]
    assert scores == sorted(scores)


def test_near_depths_are_served_by_narrow_lenses_focused_there(designs: dict[str, ml.Design]) -> None:
    layout = designs["photometric"].layout
    near = layout.focus[:, 0] < 1000
    assert near.sum() == 2
    assert (layout.aperture_radius[near] < 0.5 * layout.aperture_radius[~near].min()).all()


def test_a_short_search_of_today_is_nearly_as_good(designs: dict[str, ml.Design]) -> None:
    design = designs["photometric"]
    # A tenth of the RMSE: without variations the last foci are not found.
    assert ml.solve(design.problem, starts=16, patience=0, proof=0).rmse <= design.rmse * 1.1
