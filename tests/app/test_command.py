"""The first word of a command line, and the help of every command."""

from importlib import import_module
from pathlib import Path

import pytest

from multilens.app.command import COMMANDS, run_command


@pytest.mark.parametrize("given", [[], ["--help"], ["-h"], ["experiment=demo", "--help"]], ids=" ".join)
def test_help_is_told_without_words_and_with_the_flag(given: list[str], capsys: pytest.CaptureFixture[str]):
    assert run_command(given) == 0
    out = capsys.readouterr().out
    assert [name for name in COMMANDS if f"multilens {name} " not in out] == []


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_every_command_has_help_with_examples(name: str, flag: str, capsys: pytest.CaptureFixture[str]):
    assert run_command([name, flag]) == 0
    out = capsys.readouterr().out
    assert out == import_module(f"multilens.app.{name.replace('-', '_')}").USAGE + "\n"
    assert out.startswith(f"multilens {name} ")
    examples = out.split("\nExamples\n")[1].splitlines()
    assert examples[0].startswith(f"  multilens {name} ")
    assert [line for line in out.splitlines() if len(line) > 131] == []


@pytest.mark.parametrize(
    ("first", "meant"),
    [
        ("evalute", "did you mean evaluate?"),
        ("val", "did you mean validate-config?"),
        ("demo", "did you mean experiment=demo?"),
        ("xyzzy", "see multilens --help"),
    ],
)
def test_an_unknown_command_is_refused_with_the_nearest(
    first: str, meant: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    assert run_command([first, "experiment=demo"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert f"got {first}" in err
    assert meant in err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("first", ["~back.keep_outs.logo", "+back.keep_outs={}", "--cfg"])
def test_what_hydra_takes_first_is_no_unknown_command(
    first: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    words = [first, *(["job"] if first == "--cfg" else ["--cfg", "job"]), "-p", "name"]
    monkeypatch.setattr("sys.argv", ["multilens", *words])
    assert run_command(words) == 0
    assert capsys.readouterr().out.strip() == "design"


def test_flags_may_stand_between_keys(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    words = ["design", "experiment=demo", "--cfg", "job", "lenses.count=7", "-p", "lenses.count"]
    assert run_command(words) == 0
    assert capsys.readouterr().out.strip() == "7"


@pytest.mark.parametrize("flag", [["--config-dir", "design"], ["--config-dir=design"], ["-cd", "design"]])
def test_flags_may_stand_before_the_command(
    flag: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    (tmp_path / "design").mkdir()
    monkeypatch.chdir(tmp_path)
    assert run_command([*flag, "validate-config", "experiment=demo"]) == 0
    assert capsys.readouterr().out.startswith("OK: demo")
