import re
from argparse import Namespace
from functools import cache
from inspect import signature
from itertools import combinations, takewhile
from math import dist, inf
from pathlib import Path

import pytest
from hydra import compose

from multilens.app import build
from multilens.app.command import run_command
from multilens.app.compose import config_folder, open_hydra
from multilens.app.schema import Config
from multilens.back import Back
from multilens.cad.export import export
from multilens.geometry.shape import disc
from multilens.layout import Layout

CONF = config_folder()
FILES = sorted(path.relative_to(CONF).with_suffix("").as_posix() for path in CONF.rglob("*.yaml"))
CHOICES = [name.split("/", 1) for name in FILES if "/" in name]
NO_MORE_FOLDERS = Namespace(config_path=None, config_dir=None)


@cache
def composed(*overrides: str) -> Config:
    with open_hydra(NO_MORE_FOLDERS):
        return build.typed(compose("config", list(overrides)))


@pytest.fixture(scope="session")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("drawing") / "back.geojson"
    export(Back.rectangle(60, 60), path)
    return path


@pytest.mark.parametrize(("group", "name"), CHOICES)
def test_every_preset_composes_builds_and_scores(group: str, name: str, drawing: Path):
    # The one preset that needs a word more is the back that is read from a file.
    more = [f"back.file.path={drawing}"] if (group, name) == ("back", "file") else []
    config = composed(f"{group}={name}", *more)
    build.check(config)
    problem = build.build_question(config)
    lenses = problem.lenses
    tiers = max(lens.tiers for lens in lenses)
    # Wherever they are, apart from each other: a score needs no room.
    position = [[40.0 * index, 0.0] for index in range(len(lenses))]
    focus = [[1.01 * near] * tiers for near, _ in problem.focus_range]
    layout = Layout(position, [lens.aperture_radius[1] for lens in lenses], focus)
    assert 0 < problem.score(layout).item() < inf


DEVICES = [f"{group}={name}" for group, name in CHOICES if name.startswith("devices/")]


@pytest.mark.parametrize("device", DEVICES)
def test_every_device_is_evaluated(device: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("multilens.search.evaluate.STARTS", 2)
    monkeypatch.setattr("multilens.search.evaluate.PATIENCE", 0)
    assert run_command(["evaluate", "experiment=" + device.partition("=")[2], "depth.count=16"]) == 0
    assert "as given" in capsys.readouterr().out


@pytest.mark.parametrize("device", DEVICES)
def test_the_lenses_of_a_device_fit_on_it(device: str):
    config = composed(device)
    back, lenses = build.build_back(config.back).outline.polygon(), build.build_lenses(config.lenses)
    for lens in lenses:
        x, y = lens.position or (None, None)
        assert x is not None
        assert y is not None
        assert back.contains(disc((x, y), lens.aperture_radius[1]).polygon())


@pytest.mark.parametrize(
    ("device", "baselines"),
    [
        ("iphone_13_pro", [17.92, 18.91, 18.91]),
        ("iphone_15_pro_max", [19.24, 20.40, 20.40]),
        ("pixel_4", [13.0]),
        ("oak_d", [75.0]),
        ("d3s", [4.0]),
    ],
)
def test_lenses_stand_as_far_apart_as_published(device: str, baselines: list[float]):
    places = [lens.position for lens in build.build_lenses(composed(f"lenses={device}").lenses)]
    apart = sorted(dist(one, other) for one, other in combinations(places, 2))  # pyright: ignore[reportArgumentType] -- all are locked
    assert [round(distance, 2) for distance in apart] == baselines


def test_an_oak_d_sees_95_pixels_of_disparity_at_its_published_distance():
    # docs.luxonis.com: 882.5 pixels of focal length, 75 mm, 95 pixels: 69.7 cm. Pixels are 3.0 um.
    lens = build.build_lenses(composed("lenses=oak_d").lenses)[0]
    assert lens.focal_length / 0.003 * 75 / 95 == pytest.approx(697, abs=0.5)


def test_eyes_of_the_crab_spider_are_as_far_apart_as_published():
    # Tang and others 2008, rim to rim: AME-AME 0.18, AME-ALE 0.16, PME-PME 0.30, PME-PLE 0.32 mm.
    eyes = build.build_lenses(composed("lenses=crab_spider").lenses)

    def rim_to_rim(one: int, other: int) -> float:
        first, second = eyes[one], eyes[other]
        centres = dist(first.position, second.position)  # pyright: ignore[reportArgumentType] -- both are locked
        return centres - first.aperture_radius[0] - second.aperture_radius[0]

    apart = [rim_to_rim(*pair) for pair in ((0, 1), (1, 3), (4, 5), (5, 7))]
    assert apart == pytest.approx([0.18, 0.16, 0.30, 0.32])


def test_a_place_that_no_source_gives_is_marked():
    for name in (
        "iphone_14",
        "iphone_14_pro",
        "pixel_7",
        "pixel_7_pro",
        "find_x5_pro",
        "galaxy_s23",
        "galaxy_s23_ultra",
    ):
        assert composed(f"lenses={name}").lenses.places is None
        assert "places" in composed(f"experiment=devices/{name}").lenses.estimates


@pytest.mark.parametrize("name", FILES)
def test_every_file_says_first_what_it_is_and_its_source(name: str):
    lines = (CONF / f"{name}.yaml").read_text().splitlines()
    comment = " ".join(takewhile(lambda line: line.startswith("#"), lines))
    assert "Source: " in comment


@pytest.mark.parametrize("name", [name for group, name in CHOICES if group == "experiment"])
def test_an_experiment_begins_with_the_command_that_runs_it(name: str):
    lines = (CONF / "experiment" / f"{name}.yaml").read_text().splitlines()
    assert lines[:2] == ["# @package _global_", f"# multilens experiment={name}"]


def test_the_default_search_is_that_of_solve():
    from multilens.search.solve import solve

    config = composed()
    defaults = {name: parameter.default for name, parameter in signature(solve).parameters.items()}
    assert (config.search.starts, config.search.patience) == (defaults["starts"], defaults["patience"])


def test_no_file_names_a_class_but_the_table_of_a_sweep():
    targets = [target for path in CONF.rglob("*.yaml") for target in re.findall(r"_target_: *(\S+)", path.read_text())]
    assert targets == ["multilens.app.sweep.SweepTable"]


APPLE_SHROUDS = [(14.17, 14.17), (14.17, 33.41), (32.16, 23.79)]
"""Centres of the lenses in Apple's drawing of the iPhone 15 Pro Max, mm from its top left."""


def island() -> Back:
    return build.build_back(composed("back=iphone_15_pro_max_island").back)


@pytest.mark.parametrize("centre", APPLE_SHROUDS)
def test_the_island_holds_apples_shrouds(centre: tuple[float, float]):
    assert island().outline.polygon().contains(disc(centre, 8.1).polygon())


def test_the_island_holds_its_keep_outs():
    back = island()
    assert all(back.outline.polygon().contains(keep_out.shape.polygon()) for keep_out in back.keep_outs)


def test_the_island_lies_on_the_phone():
    phone = build.build_back(composed("back=iphone_15_pro_max").back)
    assert phone.outline.polygon().contains(island().outline.polygon())


def test_a_body_at_full_aperture_is_as_large_as_apples_shroud():
    lens = build.build_lenses(composed("lenses=iphone_main").lenses)[0]
    assert lens.aperture_radius[1] + lens.clearance == pytest.approx(16.20 / 2, abs=0.01)


def test_the_wheel_takes_the_configuration_along():
    import tomllib

    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())
    assert project["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"] == {"conf": "multilens/conf"}
