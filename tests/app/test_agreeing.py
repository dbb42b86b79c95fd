"""Sweeps whose jobs agree, from the command line."""

import json
import shutil
from pathlib import Path

import jaxtyping
import pytest

from multilens.app.agreeing import let_neighbours_agree
from multilens.app.command import run_command

pytestmark = pytest.mark.xdist_group("agreeing")

# The score has no closed form: single starts of it are found badly.
WEAK = [
    "experiment=phone_back",
    "metric=worst_case",
    "depth.count=16",
    "search.starts=1",
    "search.patience=0",
    "search.proof=1",
]
SWEPT = ["lenses.count=2,3,4", "back.outline.width=72,77"]


def swept(folder: Path, *given: str) -> dict[tuple[int, float], float]:
    """Give the score of each count and width."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
        command = ["-m", *WEAK, *SWEPT, f"hydra.sweep.dir={folder}", *given]
        monkeypatch.setattr("sys.argv", ["multilens", *command])
        assert run_command(command) == 0
    rows = [json.loads(line) for line in (folder / "table.jsonl").read_text().splitlines()]
    return {(row["lens_count"], float(row["settings"]["back.outline.width"])): row["score"] for row in rows}


@pytest.fixture(scope="module")
def agreed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[tuple[int, float], float]]:
    folder = tmp_path_factory.mktemp("agreed") / "sweep"
    return folder, swept(folder)


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[tuple[int, float], float]]:
    folder = tmp_path_factory.mktemp("alone") / "sweep"
    return folder, swept(folder, "sweep.agree=false")


def test_more_is_never_worse_in_the_table(agreed) -> None:
    _, scores = agreed
    for (count, width), score in scores.items():
        assert scores.get((count + 1, width), 0.0) <= score * (1 + 2e-6)
        assert scores.get((count, width + 5), 0.0) <= score * (1 + 2e-6)


def test_no_job_is_worse_than_alone_and_some_are_better(agreed, alone) -> None:
    _, together = agreed
    _, each = alone
    assert all(together[job] <= each[job] for job in each)
    assert any(together[job] < each[job] * (1 - 1e-3) for job in each)


def test_left_out_nothing_agrees(alone) -> None:
    folder, _ = alone
    assert not list(folder.rglob("alone.json"))
    assert not (folder / "agreement.json").exists()


def test_what_a_job_found_alone_is_kept(agreed, alone) -> None:
    kept = list(agreed[0].glob("*/alone.json"))
    assert kept
    for path in kept:
        assert path.read_bytes() == (alone[0] / path.parent.name / "design.json").read_bytes()


def test_how_many_became_better_is_told(agreed, capsys: pytest.CaptureFixture[str]) -> None:
    folder, _ = agreed
    assert let_neighbours_agree(folder)
    better = len(list(folder.glob("*/alone.json")))
    assert capsys.readouterr().out == f"jobs that are better by their neighbours' layouts: {better}\n"


def test_a_damaged_job_is_told_in_one_line(tmp_path: Path, alone, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "sweep"
    shutil.copytree(alone[0], folder)
    (folder / "2" / "design.json").write_text("{}")
    assert not let_neighbours_agree(folder)
    told = capsys.readouterr().err
    assert told.startswith("multilens: neighbours cannot agree: ")
    assert "design.json" in told
    assert told.count("\n") == 1
