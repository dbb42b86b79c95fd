"""The study's result still holds: part of it predicted again, numbers worked by hand, and the working range of the library."""

import csv
from pathlib import Path
from types import ModuleType

import pytest
import torch

import multilens as ml
from multilens.working_range import working_range

STUDY = Path(__file__).parent
MODULES = ("published", "settings", "systems", "predict")
"""Of the study, in the order of their imports."""


def table(name: str) -> list[dict[str, str]]:
    with (STUDY / "results" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def rows(system: str, texture: str, way: str) -> list[dict[str, str]]:
    return [
        row
        for row in table("table")
        if (row["system"], row["texture of"], row["measured by"]) == (system, texture, way)
    ]


@pytest.mark.parametrize(
    ("system", "title", "way"), [("oak_d", "OAK-D", "stereo"), ("focal_track", "Focal Track", "focus stays")]
)
def test_the_shares_of_a_system_are_found_again(
    study: dict[str, ModuleType], system: str, title: str, way: str
) -> None:
    predict = study["predict"]
    error = predict.errors(system, list(study["settings"].settings(system)))[way]
    claims = [claim for claim in study["published"].CLAIMS if claim.system == system]
    for claim, row in zip(claims, rows(title, "one size", way), strict=True):
        band = predict.band(claim, "one size", way, error)
        assert (f"{band.measuring:.0%}", f"{band.covering:.0%}") == (
            row["that keep it anywhere"],
            row["that keep it over all that is published"],
        )


def test_oak_ds_near_end_is_the_published_one_under_every_setting() -> None:
    for row in rows("OAK-D", "one size", "stereo") + rows("OAK-D", "all sizes", "stereo"):
        nearest, median, farthest = row["near end: nearest, median, farthest (m)"].split(", ")
        # 882.5 * 75 / 95 = 696.7 mm; depths are looked at 0.93 % apart.
        assert nearest == median == farthest
        assert float(nearest) == pytest.approx(0.6967, rel=0.0093)


def test_what_published_accuracy_means_is_what_is_worked_by_hand() -> None:
    found = [float(row["error of the shift that it means (pixels)"]) for row in table("shifts")]
    # 10 mm / 0.7979 * 4 * 12 / 1640^2 / 0.002; 0.02 * 75 * 2.6475 / 0.7979 / 4000 / 0.003 and its likes.
    assert found[:4] == pytest.approx([0.1118, 0.4148, 0.4740, 0.4740], rel=5e-3)


def test_stereo_covers_all_that_d3s_publishes_without_defocus() -> None:
    for texture in ("one size", "all sizes"):
        shares = [rows("D3S", texture, way)[0]["that keep it over all that is published"] for way in ("stereo", "both")]
        assert shares[0] == shares[1] != "0%"


def test_a_texture_of_all_sizes_is_never_worse_than_one_of_its_own(study: dict[str, ModuleType]) -> None:
    setting = study["settings"].Setting(0.1, None, 21, 500.0, 0.2, 0.5, 4.0, 2.0)
    depths = ml.log_depths(200, 3000, 50)
    every = study["predict"].errors("d3s", [setting], depths)["both"][0]
    for size in study["settings"].sizes(setting):
        assert (every <= study["systems"].d3s(size, depths)["both"]).all()


def test_the_ends_are_those_that_the_library_finds(study: dict[str, ModuleType]) -> None:
    setting, claim = study["settings"].Setting(0.1, 8, 11, 500.0), study["published"].CLAIMS[5]
    error = study["systems"].oak_d(setting, study["predict"].DEPTHS)["stereo"]
    near, far = study["predict"].longest(study["predict"].kept(claim, error))
    cue = ml.PhotometricStereo(setting.scene(3.0), study["systems"].OAK_D_LIMITS)
    lenses = study["systems"].LENSES["oak_d"]
    problem = ml.Problem(ml.Back.rectangle(110, 54.5), lenses, [1000.0], cues=[cue])
    radius = lenses[0].aperture_radius[0]
    layout = ml.Layout([lens.position for lens in lenses], [radius] * 2, [392.0] * 2)
    # A mean absolute error of 2 % is a standard deviation of 2.507 %.
    ((begin, end),) = working_range(problem, layout, ml.Tolerance(percent=2.507), (100, 150_000)).intervals
    assert (near, far) == pytest.approx((begin, end), rel=0.0093)


def test_a_stretch_is_the_longest(study: dict[str, ModuleType]) -> None:
    depths = torch.tensor([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    longest = study["predict"].longest
    assert longest(torch.tensor([True, False, True, True, True, False]), depths) == (3.0, 5.0)
    assert longest(torch.tensor([False] * 6), depths) is None
