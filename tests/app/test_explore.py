"""Whole explorations, each with a few searches of a tenth of a second, and what is refused before the first."""

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from multilens.app.command import run_command
from multilens.sweeps.locks import clear_half_written

pytestmark = pytest.mark.xdist_group("explore")

SMALL = ["back=rectangle", "cues=stereo", "lenses.count=2", "depth.count=8", "search.starts=2", "search.patience=0"]
TINY = [*SMALL, "search.proof=0"]
WIDTH = "back.outline.width=interval(30,70)"


def explore(*words: str) -> int:
    return run_command(["explore", *words])


def best(folder: Path) -> list[dict[str, str]]:
    return list(csv.DictReader((folder / "best.csv").read_text().splitlines()))


def rows(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "table.jsonl").read_text().splitlines()]


@pytest.fixture(scope="module")
def island(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of an exploration by stereo alone, where a wider back can only help."""
    folder = tmp_path_factory.mktemp("explored") / "island"
    assert explore(*TINY, "back.outline.height=20", WIDTH, "minimise=rmse", "trials=8", f"out={folder}") == 0
    return folder


def test_the_best_by_stereo_alone_is_the_widest(island: Path):
    (widest,) = best(island)
    widths = {row["job"]: float(row["settings"]["back.outline.width"]) for row in rows(island)}
    assert len(widths) == 8
    assert widths[int(widest["job"])] == max(widths.values()) > 65


def test_each_trial_is_a_job_as_of_a_sweep(island: Path):
    for number in range(8):
        assert {"config.yaml", "design.json", "layout.csv", "row.json", "run.log"} <= {
            path.name for path in (island / str(number)).iterdir()
        }


def test_the_same_command_computes_nothing_again(
    island: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("multilens.search.solve.solve", None)
    assert explore(*TINY, "back.outline.height=20", WIDTH, "minimise=rmse", "trials=8", f"out={island}") == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(island / "best.csv")


def test_the_best_are_not_cleared_away_by_another_process_while_they_are_written(
    island: Path, monkeypatch: pytest.MonkeyPatch
):
    replace = os.replace

    def clear_and_replace(written: Path, path: Path) -> None:
        clear_half_written(island)
        replace(written, path)

    monkeypatch.setattr("os.replace", clear_and_replace)
    assert explore(*TINY, "back.outline.height=20", WIDTH, "minimise=rmse", "trials=8", f"out={island}") == 0


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        (["minimise=body_area", WIDTH], "minimise was rmse there and is body_area now"),
        (["minimise=rmse", "seed=1", WIDTH], "seed was 0 there and is 1 now"),
        (["minimise=rmse", "back.outline.width=interval(30,60)"], "back.outline.width was interval(30,70) there"),
        (["minimise=rmse", WIDTH, "search.seed=1"], "search.seed was 0 there and is 1 now"),
    ],
)
def test_another_exploration_in_the_same_folder_is_refused(
    changed: list[str], told: str, island: Path, capsys: pytest.CaptureFixture[str]
):
    assert explore(*TINY, "back.outline.height=20", *changed, "trials=8", f"out={island}") == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1


def test_a_front_is_told_and_where_nothing_fits_there_is_no_number(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    folder = tmp_path / "front"
    space = ["back.outline.width=interval(4,70)", "lenses.count=range(2,4)"]
    few = [word for word in TINY if not word.startswith("lenses.count")]
    assert explore(*few, *space, "back.outline.height=20", "minimise=rmse,back_area", "trials=8", f"out={folder}") == 0
    found = {row["job"]: (row["rmse_mm"], row["back_area_mm2"]) for row in rows(folder) if row["status"] == "complete"}
    beaten = {
        job
        for job, (error, area) in found.items()
        for other in found.values()
        if other != (error, area) and other[0] <= error and other[1] <= area
    }
    assert {int(row["job"]) for row in best(folder)} == set(found) - beaten
    nothing = [row for row in rows(folder) if row["status"] != "complete"]
    assert {row["status"] for row in nothing} == {"infeasible"}
    assert all(row["rmse_mm"] is None for row in nothing)
    assert capsys.readouterr().out.splitlines()[-1] == str(folder / "best.csv")


def test_where_nothing_fits_at_all_the_exit_code_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = [*TINY, "back.outline.height=3", "back.outline.width=interval(2,4)"]
    assert explore(*words, "trials=2", f"out={tmp_path / 'none'}") == 3
    assert "none of 2 trials has a design" in capsys.readouterr().err
    assert len(rows(tmp_path / "none")) == 2


def test_what_does_not_go_together_is_a_row_and_the_exploration_goes_on(tmp_path: Path):
    """Each end is admissible by itself, a near limit beyond the far one is not."""
    space = ["depth.near=interval(100,900)", "depth.far=choice(5000,500)"]
    words = [*TINY, *space, "minimise=rmse", "trials=8", f"out={tmp_path / 'depths'}"]
    assert explore(*words) == 0
    table = rows(tmp_path / "depths")
    apart = [float(row["settings"]["depth.near"]) < float(row["settings"]["depth.far"]) for row in table]
    assert [row["status"] != "refused" for row in table] == apart
    assert (len(table), set(apart)) == (8, {True, False})


BAD = {
    "no folder": ([WIDTH], "out must be a folder"),
    "nothing to choose": (["out=x"], "explore must have something to choose"),
    "no such objective": (["out=x", WIDTH, "minimise=rms"], "did you mean rmse?"),
    "an objective twice": (["out=x", WIDTH, "minimise=rmse,rmse"], "each once"),
    "no objective": (["out=x", WIDTH, "minimise="], "got none"),
    "no trials": (["out=x", WIDTH, "trials=0"], "trials must be a whole number >= 1, got 0"),
    "a seed below 0": (["out=x", WIDTH, "seed=-1"], "seed must be a whole number >= 0, got -1"),
    "trials twice": (["out=x", WIDTH, "trials=1", "trials=2"], "trials must be given once"),
    "an end out of its range": (["out=x", "lenses.count=range(0,3)"], "from 1 to 64, got 0"),
    "the other end": (["out=x", "lenses.count=int(interval(1,65))"], "from 1 to 64, got 65"),
    "fractions of what is whole": (["out=x", "lenses.count=interval(1,3)"], "lenses.count=1.7"),
    "a step that leaves whole numbers": (["out=x", "lenses.count=range(1,3.5,0.5)"], "lenses.count=1.5"),
    "a flag": (["out=x", WIDTH, "--fast"], "expected key=value"),
}


@pytest.mark.parametrize(("words", "told"), BAD.values(), ids=BAD.keys())
def test_bad_words_are_refused_in_one_line_and_leave_no_folder(
    words: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    assert explore(*words) == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_machine_without_optuna_is_told(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("multilens.app.explore.find_spec", lambda name: None)
    assert explore(WIDTH, "out=x") == 2
    assert "pip install 'multilens[optuna]'" in capsys.readouterr().err


def test_an_exploration_that_was_killed_goes_on_where_it_was(tmp_path: Path):
    words = [*TINY, "back.outline.height=20", WIDTH, "minimise=rmse", "trials=4", "out=killed"]
    command = [sys.executable, "-c", "from multilens.app import main; main()", "explore", *words]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL) as process:
        deadline = monotonic() + 100
        while not (tmp_path / "killed/1/row.json").exists() and process.poll() is None and monotonic() < deadline:
            sleep(0.01)
        os.kill(process.pid, signal.SIGKILL)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.glob("killed/*/row.json")}
    assert len(before) >= 2
    assert subprocess.run(command, cwd=tmp_path, stdout=subprocess.DEVNULL, timeout=100).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    words[-1] = f"out={tmp_path / 'whole'}"
    assert explore(*words) == 0
    for number in range(4):
        design = f"{number}/design.json"
        assert (tmp_path / "killed" / design).read_bytes() == (tmp_path / "whole" / design).read_bytes()
