"""`multilens animate`, the whole command."""

from pathlib import Path

import jaxtyping
import pytest
from PIL import Image

import multilens as ml
from multilens.app.command import run_command
from multilens.search.evaluate import as_given


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("saved")
    lens = ml.Lens(5.0, (1.0, 1.0), (200, 2000), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(ml.Back.rectangle(40, 40), [lens] * 2, ml.log_depths(300, 2000, 24), cues=[ml.PairStereo()])
    ml.solve(problem, starts=2, patience=0, proof=0).save(folder / "design.json")
    return folder


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    monkeypatch.setattr("multilens.plot.animation.DOTS_PER_INCH", 20)


def test_a_run_is_animated(saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert run_command(["animate", str(saved), "out=film.gif"]) == 0
    assert capsys.readouterr().out == "film.gif\n"
    with Image.open(tmp_path / "film.gif") as film:
        assert getattr(film, "n_frames", 1) > 10


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "one run folder"),
        (["nowhere"], "no design.json"),
        (["SAVED", "out=film.mp4"], "ends in .gif"),
        (["SAVED", "more"], "one run folder"),
        (["PLACED"], "searched for from fresh starts"),
    ],
)
def test_what_cannot_be_animated_is_refused(
    words: list[str], told: str, saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    design = ml.Design.load(saved / "design.json")
    (tmp_path / "placed").mkdir()
    as_given(design.problem, design.layout).save(tmp_path / "placed" / "design.json")
    names = {"SAVED": str(saved), "PLACED": "placed"}
    assert run_command(["animate", *(names.get(word, word) for word in words)]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert told in err
    assert not list(tmp_path.glob("*.gif"))
