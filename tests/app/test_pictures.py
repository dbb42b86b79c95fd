"""The pictures of a sweep from the command line."""

import json
from pathlib import Path

import pytest
from hydra_plugins.hydra_joblib_launcher.config import JobLibLauncherConf
from omegaconf import OmegaConf

from multilens.app.command import run_command
from multilens.app.pictures import pictures_drawn
from multilens.app.workers import computing_as, end_workers
from multilens.sweeps.compute import Compute

SMALL = ["experiment=spider", "search.starts=2", "search.patience=0", "search.proof=1", "depth.count=16"]


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a sweep of one and two lenses."""
    folder = tmp_path_factory.mktemp("swept") / "sweep"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("multilens.plot.figures.DOTS_PER_INCH", 20)
        assert run_command(["-m", *SMALL, "lenses.count=1,2", f"hydra.sweep.dir={folder}"]) == 0
    return folder


def test_a_sweep_ends_with_its_pictures(swept: Path):
    assert {path.stem for path in swept.glob("*.png")} == {path.stem for path in swept.glob("*.svg")}
    assert {path.stem for path in swept.glob("*.svg")} == {"count", "layouts", "front"}


def test_plot_draws_them_again_and_tells_where(
    swept: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("multilens.plot.figures.DOTS_PER_INCH", 20)
    before = {path: path.read_bytes() for path in swept.glob("*.*") if path.is_file()}
    (swept / "count.svg").unlink()
    assert run_command(["plot", str(swept)]) == 0
    assert str(swept / "count.svg") in capsys.readouterr().out.splitlines()
    assert {path: path.read_bytes() for path in before} == before


def test_workers_draw_the_same(swept: Path):
    pictures = [swept / f"{stem}.{kind}" for stem in ("count", "layouts", "front") for kind in ("svg", "png")]
    assert pictures_drawn(swept)
    before = [path.read_bytes() for path in pictures]
    for path in pictures:
        path.unlink()
    try:
        assert pictures_drawn(swept, computing_as(OmegaConf.structured(JobLibLauncherConf(n_jobs=2))))
    finally:
        end_workers()
    assert [path.read_bytes() for path in pictures] == before


def test_plot_of_a_sweep_that_found_nothing_is_refused(swept: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "0").mkdir()
    (tmp_path / "0" / "row.json").write_text(json.dumps({"damaged": True}))
    assert run_command(["plot", str(tmp_path)]) == 2
    assert "none of its jobs has one" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "reason"),
    [(OSError(28, "No space left on device"), "No space left"), (KeyError("front"), "KeyError: 'front'")],
)
def test_pictures_that_cannot_be_drawn_are_told_in_one_line(
    error: Exception, reason: str, swept: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def failing(folder: Path, compute: Compute) -> None:
        raise error

    monkeypatch.setattr("multilens.sweeps.pictures.draw_pictures", failing)
    assert not pictures_drawn(swept)
    told = capsys.readouterr().err
    assert reason in told
    assert told.count("\n") == 1
