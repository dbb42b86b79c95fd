"""What can be swept, as Hydra's users write it, and that the table has a column for it; no job searches."""

import json
from pathlib import Path

import pytest
from hydra.core.utils import JobReturn
from omegaconf import DictConfig

from multilens.app.command import run_command
from multilens.app.search import NothingFoundError
from multilens.app.sweep import SweepTable


@pytest.fixture(autouse=True)
def _nothing_is_searched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(config, visible):
        raise NothingFoundError("nobody searched")

    monkeypatch.setattr("multilens.app.sweep_job.searched", nothing)
    monkeypatch.setattr("multilens.app.sweep.pictures_drawn", lambda *given: True)
    monkeypatch.chdir(tmp_path)


def settings(monkeypatch: pytest.MonkeyPatch, *given: str) -> list[dict[str, str]]:
    command = [*given, "hydra.sweep.dir=s"]
    monkeypatch.setattr("sys.argv", ["multilens", *command])
    assert run_command(command) == 3
    return [json.loads(line)["settings"] for line in Path("s/table.jsonl").read_text().splitlines()]


@pytest.mark.parametrize(
    ("word", "key", "values"),
    [
        ("lenses.count=2,3", "lenses.count", ["2", "3"]),
        ("lenses.count=range(1,4)", "lenses.count", ["1", "2", "3"]),
        ("scene.light_lux=choice(20,500)", "scene.light_lux", ["20", "500"]),
        ("depth=portrait,room", "depth", ["portrait", "room"]),
        ("depth.near=200,300", "depth.near", ["200", "300"]),
        ("back.outline.width=60,70", "back.outline.width", ["60", "70"]),
        ("back=rectangle,disc", "back", ["rectangle", "disc"]),
        ("lenses.lens.f_number=[1.8,8],[2.8,8]", "lenses.lens.f_number", ["[1.8,8]", "[2.8,8]"]),
        ("lenses.lens.disparity_noise=1e-4,2e-4", "lenses.lens.disparity_noise", ["0.0001", "0.0002"]),
        ("metric=mean_square,relative", "metric", ["mean_square", "relative"]),
        ("search.seed=0,1", "search.seed", ["0", "1"]),
        ("experiment=spider,demo", "experiment", ["spider", "demo"]),
    ],
)
def test_what_is_swept_is_a_column_and_what_is_fixed_is_none(word, key, values, monkeypatch) -> None:
    assert settings(monkeypatch, "-m", "search=quick", word) == [{key: value} for value in values]


def test_an_experiment_can_hold_the_sweep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine" / "experiment").mkdir(parents=True)
    (tmp_path / "mine" / "experiment" / "counts.yaml").write_text(
        "# @package _global_\n"
        "hydra:\n  mode: MULTIRUN\n  sweeper:\n    params:\n      lenses.count: range(1,3)\n      depth: portrait,room\n"
    )
    assert settings(monkeypatch, "--config-dir=mine", "experiment=counts", "search=quick") == [
        {"lenses.count": count, "depth": depth} for count in "12" for depth in ("portrait", "room")
    ]


def test_the_jobs_of_different_experiments_lie_in_one_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    command = ["-m", "experiment=spider,demo"]
    monkeypatch.setattr("sys.argv", ["multilens", *command])
    assert run_command(command) == 3
    (folder,) = Path("sweeps/spider").iterdir()
    assert {path.name for path in folder.iterdir()} >= {"0", "1", "table.csv"}
    assert [path.name for path in Path("sweeps").iterdir()] == ["spider"]


def test_a_folder_may_be_called_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    name = "it's = a, {b}"
    command = ["-m", "search.seed=0,1", f'hydra.sweep.dir="{name}"']
    monkeypatch.setattr("sys.argv", ["multilens", *command])
    assert run_command(command) == 3
    assert (Path(name) / "1" / "row.json").is_file()


def test_what_hydra_remembers_of_a_job_is_not_its_configuration() -> None:
    done = JobReturn(overrides=["lenses.count=2"], cfg=DictConfig({"lenses": {"count": 2}}), hydra_cfg=DictConfig({}))
    SweepTable().on_job_end(DictConfig({}), done)
    assert (done.overrides, done.cfg, done.hydra_cfg) == (["lenses.count=2"], None, None)
