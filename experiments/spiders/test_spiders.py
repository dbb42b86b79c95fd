"""The study's result still holds: stored eyes, the law of tiers, and closed forms."""

import csv
from pathlib import Path

import pytest

import multilens as ml

RESULTS = Path(__file__).parent / "results"
FAMILIES = ["crab_spider", "wolf_spider", "jumping_spider"]


def table(name: str) -> list[dict[str, str]]:
    with (RESULTS / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_has_four_pairs_of_eyes_that_mirror_each_other(family: str) -> None:
    places = ml.Design.load(RESULTS / f"{family}.json").layout.position.tolist()
    assert len(places) == 8
    for (x, y), (mirrored, same) in zip(places[::2], places[1::2], strict=True):
        assert (x, y) == (-mirrored, same)


def test_only_the_principal_eyes_of_the_jumping_spider_have_tiers() -> None:
    tiers = [lens.tiers for lens in ml.Design.load(RESULTS / "jumping_spider.json").problem.lenses]
    assert tiers == [4, 4, 1, 1, 1, 1, 1, 1]


def test_every_pair_of_every_family_has_a_row() -> None:
    assert len(table("pairs")) == 3 * 5


def test_two_cues_are_never_worse_than_one() -> None:
    for row in table("pairs"):
        alone = min(float(row["stereo alone (mm)"]), float(row["defocus alone (mm)"]))
        assert float(row["both (mm)"]) <= alone * 1.005


def test_eight_eyes_are_never_worse_than_a_pair() -> None:
    rows = table("pairs")
    for first in range(0, len(rows), 5):
        pairs = [float(row["both (mm)"]) for row in rows[first : first + 4]]
        assert float(rows[first + 4]["both (mm)"]) <= min(pairs) * 1.005


def test_tiers_divide_the_error_by_their_number() -> None:
    # In a narrow range each of t tiers owns a t-th of the depths, and its error grows with the distance from its focus: 1/t.
    for row in table("tiers"):
        one, *more = (float(row[f"{tiers} tier{'s' if tiers > 1 else ''} (mm)"]) for tiers in (1, 2, 3, 4))
        for tiers, rmse in zip((2, 3, 4), more, strict=True):
            assert rmse == pytest.approx(one / tiers, rel=0.06)


def test_stereo_of_the_crab_spiders_widest_pair_is_the_closed_form() -> None:
    # Mean of (Z^2 / (b f))^2 over 20 to 50 mm, noise 0.001 mm: ALE-ALE, b = 0.92 mm, f = 0.22 mm; 200 depths against the integral.
    row = table("pairs")[1]
    mean = (50**5 - 20**5) / (5 * 30)
    assert float(row["stereo alone (mm)"]) == pytest.approx(0.001 * mean**0.5 / (0.92 * 0.22), rel=0.01)
