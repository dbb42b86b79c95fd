from pathlib import Path

import pytest

from multilens.app.command import run_command

REFUSED = {
    "nothing": (["report"], ["report must be given one folder", "got none"]),
    "no folder": (["report", "nowhere"], ["nowhere must be the folder of a run", "design.json"]),
    "two folders": (["report", "a", "b"], ["one folder", "got a b"]),
    "a flag": (["report", "--all"], ["one folder", "got --all"]),
    "an unknown key": (["report", "a", "output=x"], ["one folder", "output=x"]),
    "no file": (["report", "a", "out="], ["out must be one file", "got none"]),
    "a design in place of a page": (["report", "a", "out=a/design.json"], ["ends in .html", "got a/design.json"]),
}


@pytest.mark.parametrize(("given", "told"), REFUSED.values(), ids=REFUSED)
def test_bad_input_is_refused_in_one_line(given, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run_command(given) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert [words for words in told if words not in err] == []
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_one_file_and_prints_its_path(tmp_path: Path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    assert run_command(["evaluate", "experiment=devices/oak_d", "out=oak"]) == 0
    capsys.readouterr()
    assert run_command(["report", "oak"]) == 0
    assert run_command(["report", "oak", "out=oak.html"]) == 0
    assert capsys.readouterr().out == "oak/report.html\noak.html\n"
    assert Path("oak/report.html").read_bytes() == Path("oak.html").read_bytes()


def test_a_damaged_design_is_named(tmp_path: Path, capsys):
    (tmp_path / "design.json").write_text("{}")
    assert run_command(["report", str(tmp_path)]) == 2
    assert "design.json: schema must be multilens.design" in capsys.readouterr().err
