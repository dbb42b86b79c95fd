"""Answers as JSON: one object on stdout and nothing else."""

import json
from pathlib import Path
from typing import Any

import jaxtyping
import pytest

from multilens.app.answer import answer, without_flag
from multilens.app.command import run_command
from multilens.design import Design

QUESTION = [
    "experiment=demo",
    "lenses.count=2",
    "depth.count=8",
    "search.starts=4",
    "search.patience=0",
    "search.proof=1",
]
PLACED = [*QUESTION, "lenses.places=[[14,14],[60,14]]"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)


def said(words: list[str], capsys: pytest.CaptureFixture[str], code: int = 0) -> dict[str, Any]:
    assert run_command(words) == code
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(
    "words",
    [
        ["design", *QUESTION, "hydra.run.dir=out"],
        ["evaluate", *PLACED, "out=out"],
        ["least", "lenses", "rmse=100", *QUESTION, "out=out"],
    ],
    ids=lambda words: words[0],
)
def test_the_design_is_that_of_the_file_and_the_paths_are_there(words: list[str], capsys: pytest.CaptureFixture[str]):
    told = said([*words, "--json"], capsys)
    assert told["design"] == json.loads(Path("out/design.json").read_text())
    assert sorted(told["files"]) == sorted(str(path) for path in Path("out").iterdir())


def test_without_a_folder_there_are_no_files(capsys: pytest.CaptureFixture[str]):
    told = said(["evaluate", "--json", *PLACED], capsys)
    assert told["files"] == []
    assert Design.from_json(json.dumps(told["design"])).problem.back.keep_outs


def test_least_tells_what_was_tried(capsys: pytest.CaptureFixture[str]):
    told = said(["least", "lenses", "rmse=1e-9", "most=1", *QUESTION, "--json"], capsys, code=3)
    assert told["design"] is None
    assert (told["least"]["enough"], [trial["value"] for trial in told["least"]["trials"]]) == (None, [1])


def test_a_refusal_leaves_stdout_empty(capsys: pytest.CaptureFixture[str]):
    assert run_command(["design", "--json", "depth.near=-1"]) == 2
    assert capsys.readouterr().out == ""


def test_a_sweep_has_a_table_instead(capsys: pytest.CaptureFixture[str]):
    assert run_command(["design", "--json", "-m", *QUESTION, "search.seed=0,1"]) == 2
    assert "table.jsonl" in capsys.readouterr().err


def test_a_sweep_of_an_experiment_has_a_table_instead(capsys: pytest.CaptureFixture[str]):
    assert run_command(["design", "--json", *QUESTION, "hydra.mode=MULTIRUN"]) == 2
    assert "table.jsonl" in capsys.readouterr().err
    assert not list(Path.cwd().iterdir())


@pytest.mark.parametrize("terminal", [False, True])
def test_where_no_file_can_be_written_the_answer_is_printed_once(
    terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("sys.stdout.isatty", lambda: terminal)
    with pytest.raises(OSError, match="No space left"):
        answer("said", None, full_disk, as_json=False)
    assert capsys.readouterr().out == "said\n"


def test_where_no_file_can_be_written_the_json_names_none(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(OSError, match="No space left"):
        answer("said", None, full_disk, as_json=True, least=7)
    assert json.loads(capsys.readouterr().out) == {"least": 7, "files": [], "design": None}


def full_disk() -> list[Path]:
    raise OSError(28, "No space left on device")


def test_at_a_terminal_the_words_come_before_the_files_and_else_after(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def write() -> list[Path]:
        print("written")
        return [Path("a")]

    answer("said", None, write, as_json=False)
    assert capsys.readouterr().out == "written\nsaid\n\na\n"
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    answer("said", None, write, as_json=False)
    assert capsys.readouterr().out == "said\nwritten\n\na\n"


def test_the_flag_may_stand_anywhere():
    assert without_flag(["a=1", "--json", "b=2"]) == (True, ["a=1", "b=2"])
    assert without_flag(["a=1"]) == (False, ["a=1"])
