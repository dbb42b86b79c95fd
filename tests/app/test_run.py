"""Whole commands, each with a search of a second."""

import json
from pathlib import Path

import pytest

from multilens.app.command import run_command

SMALL = ["back=rectangle", "lenses.count=2", "depth.count=8", "search.starts=4", "search.patience=0", "search.proof=1"]
TOO_SMALL = ["back.outline.width=5", "back.outline.height=5"]


def run(monkeypatch: pytest.MonkeyPatch, *given: str) -> int:
    monkeypatch.setattr("sys.argv", ["multilens", *given])
    return run_command(list(given))


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a run that was saved."""
    folder = tmp_path_factory.mktemp("saved") / "runs" / "here"
    with pytest.MonkeyPatch.context() as monkeypatch:
        assert run(monkeypatch, *SMALL, "penalty=area", "name=small", f"hydra.run.dir={folder}") == 0
    return folder


def test_a_run_leaves_a_folder_with_its_design(saved: Path):
    design = json.loads((saved / "design.json").read_text())
    assert {"config.yaml", "layout.csv", "run.log"} <= {path.name for path in saved.iterdir()}
    assert "area_penalty" in json.dumps(design)


def test_hydra_puts_nothing_into_a_run_folder(saved: Path):
    assert {path.suffix for path in saved.iterdir()} == {".yaml", ".json", ".csv", ".log", ".svg", ".png"}
    assert not (saved / ".hydra").exists()


def test_the_saved_configuration_is_what_was_asked(saved: Path):
    text = (saved / "config.yaml").read_text()
    assert "name: small\n" in text
    assert "${" not in text


def test_the_log_begins_with_the_command(saved: Path):
    first = (saved / "run.log").read_text().splitlines()[0]
    assert first == " ".join(["multilens", *SMALL, "penalty=area", "name=small"])


def test_plot_draws_the_pictures_again(
    saved: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    picture = saved / "layout.svg"
    before = picture.read_bytes()
    picture.unlink()
    assert run(monkeypatch, "plot", str(saved)) == 0
    assert picture.read_bytes() == before
    assert str(picture) in capsys.readouterr().out


def test_lenses_that_cannot_fit_leave_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, *SMALL, *TOO_SMALL) == 3
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "lens 1 needs a disc of radius" in err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_run_that_breaks_off_leaves_one_line_and_no_folder(
    error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def break_off(*given: object, **named: object) -> None:
        raise error

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("multilens.search.solve.solve", break_off)
    assert run(monkeypatch, *SMALL) == (1 if isinstance(error, OSError) else 130)
    assert capsys.readouterr().err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_no_healthy_start_is_nothing_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def no_start(*given: object, **named: object) -> None:
        raise RuntimeError("none of the 4 starts stayed healthy: scores or gradients were not finite")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("multilens.search.solve.solve", no_start)
    assert run(monkeypatch, *SMALL) == 3
    assert "none of the 4 starts" in capsys.readouterr().err


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a sweep of which the second job cannot fit."""
    folder = tmp_path_factory.mktemp("swept") / "sweep"
    with pytest.MonkeyPatch.context() as monkeypatch:
        code = run(monkeypatch, "-m", *SMALL, "back.outline.width=70,5", f"hydra.sweep.dir={folder}")
    assert code == 3
    return folder


def test_a_sweep_leaves_a_row_for_every_job(swept: Path):
    rows = (swept / "table.csv").read_text().splitlines()
    assert len(rows) == 3
    assert "complete" in rows[1]
    assert "needs a disc" in rows[2]


def test_a_job_that_found_nothing_leaves_its_reason_and_no_design(swept: Path):
    assert (swept / "0" / "design.json").is_file()
    assert not (swept / "1" / "design.json").exists()
    assert json.loads((swept / "1" / "row.json").read_text())["row"]["status"] == "infeasible"


def test_a_job_of_a_sweep_draws_no_pictures(swept: Path):
    files = {path.name for path in (swept / "0").iterdir()}
    assert files == {"config.yaml", "design.json", "layout.csv", "row.json", "run.log", "sensitivity.csv", "time.json"}


def test_version(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    assert run(monkeypatch, "--version") == 0
    assert capsys.readouterr().out.startswith("multilens 0.")


def test_a_tolerance_is_told_and_kept_with_the_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("multilens.plot.figures.DOTS_PER_INCH", 20)
    assert run(monkeypatch, *SMALL, "tolerance.percent=1", "hydra.run.dir=asked") == 0
    assert "working range" in capsys.readouterr().out
    assert json.loads((tmp_path / "asked" / "design.json").read_text())["tolerance"] == {"percent": 1.0}
