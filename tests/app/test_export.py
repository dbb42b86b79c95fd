"""`multilens export`, whole commands on a design that is saved."""

import subprocess
import sys
from pathlib import Path

import pytest

from multilens.app.command import run_command
from multilens.app.export import USAGE
from multilens.back import Back
from multilens.cad.read import read_back
from multilens.certificate import certify
from multilens.cues import PairStereo
from multilens.design import Design
from multilens.geometry.shape import disc
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem

BACK = Back.rounded_rectangle(40, 60, corner=6).keep_out("flash", disc((20, 10), 2), clearance=0.5)


@pytest.fixture(autouse=True)
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    lens = Lens(5.0, (0.5, 2.0), (200, 5000), clearance=1.0)
    problem = Problem(BACK, [lens] * 2, [300.0, 900.0], cues=[PairStereo()])
    layout = Layout([[8.0, 9.0], [31.0, 50.0]], [1.25, 2.0], [300.0, 900.0])
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    (tmp_path / "run").mkdir()
    Design(problem, layout, "complete", "", certificate).save(tmp_path / "run" / "design.json")
    return tmp_path / "run"


@pytest.mark.parametrize("source", ["run", "run/design.json"])
def test_files_are_written_and_their_paths_printed(source: str, capsys: pytest.CaptureFixture[str]):
    names = ["layout.dxf", "layout.svg", "layout.geojson", "layout.csv"]
    assert run_command(["export", source, *names]) == 0
    assert capsys.readouterr().out.splitlines() == names
    assert [read_back(name) for name in names[:3]] == [BACK] * 3


def test_a_file_that_is_there_is_kept_unless_told_otherwise(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "layout.svg").write_text("a picture")
    assert run_command(["export", "run", "layout.csv", "layout.svg"]) == 2
    told = capsys.readouterr().err
    assert told == "multilens: export: layout.svg must be a new file, it is there already: overwrite=true replaces it\n"
    assert not (tmp_path / "layout.csv").exists()
    assert run_command(["export", "run", "layout.csv", "layout.svg", "overwrite=true"]) == 0
    assert (tmp_path / "layout.svg").read_text().startswith("<svg")


def test_help_tells_what_can_be_asked(capsys: pytest.CaptureFixture[str]):
    assert run_command(["export", "--help"]) == 0
    assert capsys.readouterr().out.strip() == USAGE


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "export must be given a run folder and files, as in multilens export runs/demo layout.dxf, got none"),
        (["run"], "export must be given a run folder and files"),
        (["away", "layout.svg"], "export: away must be a design.json or the folder of a run that found one, it is not"),
        (["run", "layout.pdf"], "export: layout.pdf must end in one of .dxf, .svg, .geojson, .csv, got .pdf"),
        (["run", "layout"], "got no such end"),
        (["run", "away/layout.svg"], "export: away/layout.svg must be a file in a folder that is there"),
        (["run", "layout.svg", "overwrite=yes"], "export takes overwrite=true, got overwrite=yes"),
        (["run", "layout.svg", "--force"], "export takes a run folder, files and overwrite=true, got --force"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_one_line(words: list[str], told: str, capsys: pytest.CaptureFixture[str]):
    assert run_command(["export", *words]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert told in err


def test_a_damaged_design_is_refused(run: Path, capsys: pytest.CaptureFixture[str]):
    (run / "design.json").write_text("{")
    assert run_command(["export", "run", "layout.svg"]) == 2
    assert "must be whole JSON" in capsys.readouterr().err


def test_a_library_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.delitem(sys.modules, "multilens.cad.write_dxf", raising=False)
    monkeypatch.delitem(sys.modules, "multilens.cad.read_dxf", raising=False)
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    assert run_command(["export", "run", "layout.dxf"]) == 2
    told = "multilens: export: DXF needs ezdxf, which is not installed: pip install 'multilens[cad]'\n"
    assert capsys.readouterr().err == told


def test_help_loads_none_of_what_draws():
    program = (
        "import sys; from multilens.app.command import run_command; run_command(['export', '--help']); "
        "sys.exit(any(name in sys.modules for name in ('ezdxf', 'svgelements', 'torch')))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False, stdout=subprocess.DEVNULL).returncode == 0
