import re
from argparse import Namespace
from inspect import signature
from itertools import takewhile
from pathlib import Path

import pytest
from hydra import compose

from multilens.app import build
from multilens.app.compose import config_folder, open_hydra
from multilens.app.schema import Config
from multilens.back import Back
from multilens.geometry.shape import disc

CONF = config_folder()
FILES = sorted(path.relative_to(CONF).with_suffix("").as_posix() for path in CONF.rglob("*.yaml"))
CHOICES = [name.split("/", 1) for name in FILES if "/" in name]
NO_MORE_FOLDERS = Namespace(config_path=None, config_dir=None)


def composed(*overrides: str) -> Config:
    with open_hydra(NO_MORE_FOLDERS):
        return build.typed(compose("config", list(overrides)))


@pytest.mark.parametrize(("group", "name"), CHOICES)
def test_every_preset_composes_and_builds(group: str, name: str):
    config = composed(f"{group}={name}")
    build.check(config)
    assert len(build.build_problem(config).lenses) >= 1


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
