"""`multilens evaluate` from the command line: what it prints, writes and refuses."""

import json
from pathlib import Path

import pytest

from multilens.app.command import run_command

PAIR = [
    "evaluate",
    "back=rectangle",
    "lenses.count=2",
    "lenses.lens.f_number=[2,2]",
    "lenses.lens.focus=[1000,1000]",
    "depth.count=16",
]
PLACES = "lenses.places=[[10,10],[40,10]]"
TOO_CLOSE = "lenses.places=[[10,10],[20,10]]"


def said(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert run_command(list(words)) == 0
    return capsys.readouterr().out


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of an evaluation that was saved."""
    folder = tmp_path_factory.mktemp("saved") / "runs" / "pair"
    assert run_command([*PAIR, PLACES, f"out={folder}"]) == 0
    return folder


def test_it_prints_the_table_of_a_design(capsys: pytest.CaptureFixture[str]):
    out = said(capsys, *PAIR, PLACES)
    assert out.splitlines()[0].split()[:3] == ["lens", "x", "(mm)"]
    assert "status              as given" in out
    assert "longest baseline    30.000 mm, lens 1 to lens 2" in out


def test_it_says_what_was_fixed(capsys: pytest.CaptureFixture[str]):
    out = said(capsys, *PAIR, PLACES)
    assert "apertures: fixed, all\nfoci: fixed, all\n" in out


def test_it_says_what_it_chose(capsys: pytest.CaptureFixture[str]):
    out = said(capsys, *PAIR, PLACES, "lenses.lens.f_number=[2,4]", "lenses.lens.focus=[300,1000]")
    assert "apertures: the widest of their range, lenses 1, 2\n" in out
    assert "foci: the best, found with all else fixed, lenses 1, 2\n" in out


def test_it_tells_errors_from_the_nearest_depth_to_the_farthest(capsys: pytest.CaptureFixture[str]):
    lines = said(capsys, *PAIR, PLACES).splitlines()
    head = next(index for index, line in enumerate(lines) if line.startswith("depth (mm)"))
    depths = [float(line.split()[0]) for line in lines[head + 1 : head + 6]]
    assert (depths[0], depths[-1]) == (200.0, 5000.0)
    assert depths == sorted(depths)


def test_a_broken_clearance_is_said_and_scored(capsys: pytest.CaptureFixture[str]):
    out = said(capsys, *PAIR, TOO_CLOSE)
    # 6.17 mm of clearance and f / (2 N) = 1.715 mm of aperture each, at 10 mm.
    assert "lens 1 to lens 2 lacks 5.77 mm" in out
    assert "RMSE" in out


def test_nothing_is_written_unless_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    said(capsys, *PAIR, PLACES)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_written_as_of_a_run(saved: Path):
    assert {"design.json", "config.yaml", "layout.csv", "run.log", "layout.svg"} <= {
        path.name for path in saved.iterdir()
    }
    assert json.loads((saved / "design.json").read_text())["status"] == "as given"
    assert (saved / "run.log").read_text().startswith("multilens evaluate back=rectangle")


def test_a_saved_layout_has_the_score_that_it_was_saved_with(saved: Path, capsys: pytest.CaptureFixture[str]):
    stored = json.loads((saved / "design.json").read_text())["rmse"]
    assert f"RMSE                {stored:.6g} mm" in said(capsys, "evaluate", str(saved))
    assert f"RMSE                {stored:.6g} mm" in said(capsys, "evaluate", str(saved / "design.json"))


def test_a_saved_layout_can_be_asked_for_other_depths(saved: Path, capsys: pytest.CaptureFixture[str]):
    anew = said(capsys, "evaluate", str(saved), "depth=portrait", "depth.count=16")
    fresh = said(capsys, *PAIR, PLACES, "depth=portrait")
    assert next(line for line in anew.splitlines() if "RMSE" in line) in fresh


def test_a_saved_layout_keeps_its_tolerance_under_another_question(
    saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    said(capsys, "evaluate", str(saved), "tolerance.mm=5", f"out={tmp_path / 'tolerant'}")
    assert "working range" in said(capsys, "evaluate", str(tmp_path / "tolerant"), "metric=relative")


def test_a_saved_layout_can_be_asked_for_other_cues(saved: Path, capsys: pytest.CaptureFixture[str]):
    out = said(capsys, "evaluate", str(saved), "cues=defocus")
    assert "defocus" in out
    assert "stereo" not in out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "must be given a design.json"),
        (["nowhere"], "nowhere must be a design.json"),
        (PAIR[1:], "lens 1 has no known place: set lenses.lens.position=[x,y]"),
        (["lenses=main_and_tele"], "set lenses.each.0.position=[x,y]"),
        ([*PAIR[1:], "lenses.places=[[1,2]]"], "one for each of the 2 lenses, got 1"),
        ([*PAIR[1:], PLACES, "out="], "out must be one folder"),
        ([*PAIR[1:], PLACES, "lenses.lens.focal_length=null"], "lenses.lens.focal_length is unknown"),
        ([*PAIR[1:], "lenses.places=[[10,10],[11,10]]", "lenses.lens.focus=[500,1000]"], "must not overlap"),
    ],
)
def test_what_cannot_be_evaluated_is_refused_in_one_line(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str]
):
    assert run_command(["evaluate", *words]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert told in err


def test_a_stored_layout_keeps_its_hardware(saved: Path, capsys: pytest.CaptureFixture[str]):
    assert run_command(["evaluate", str(saved), "back=disc"]) == 2
    assert "a stored layout can be scored under another depth, field_of_view, cues" in capsys.readouterr().err


def test_a_used_folder_is_refused(saved: Path, capsys: pytest.CaptureFixture[str]):
    assert run_command([*PAIR, PLACES, f"out={saved}"]) == 2
    assert "new or empty folder" in capsys.readouterr().err


def test_a_saved_layout_can_be_asked_for_another_metric(saved: Path, capsys: pytest.CaptureFixture[str]):
    anew = said(capsys, "evaluate", str(saved), "metric=relative")
    fresh = said(capsys, *PAIR, PLACES, "metric=relative")
    assert anew.split("\n\n")[1].splitlines()[1] == fresh.split("\n\n")[1].splitlines()[1]
    assert "%" in anew.split("\n\n")[1].splitlines()[1]


def test_a_scene_means_nothing_without_its_cues(saved: Path, capsys: pytest.CaptureFixture[str]):
    assert run_command(["evaluate", str(saved), "scene=dim"]) == 2
    assert "add cues=photometric" in capsys.readouterr().err
