"""`multilens least`, whole commands with a search of a second each."""

from pathlib import Path

import jaxtyping
import pytest

from multilens.app.command import run_command
from multilens.app.least import USAGE
from multilens.design import Design

# Two lenses of radius 1 mm on a square of 40 mm, one depth to speak of: the error is 1000^2 1e-3 / (5 b) = 200 / b.
SMALL = [
    "back=rectangle",
    "back.outline.width=40",
    "back.outline.height=40",
    "lenses=unit",
    "lenses.lens.focal_length=5",
    "lenses.lens.aperture_radius=[1,1]",
    "lenses.lens.disparity_noise=1e-3",
    "cues=stereo",
    "depth.near=999.999",
    "depth.far=1000",
    "depth.count=2",
    "search.starts=4",
    "search.patience=0",
    "search.proof=100",
]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def test_help_tells_what_can_be_asked(capsys: pytest.CaptureFixture[str]):
    assert run_command(["least", "--help"]) == 0
    assert capsys.readouterr().out.strip() == USAGE


def test_the_fewest_lenses_are_told(capsys: pytest.CaptureFixture[str]):
    assert run_command(["least", "lenses", "rmse=5", *SMALL]) == 0
    said = capsys.readouterr().out
    assert said.startswith("least lenses for RMSE <= 5 mm\n")
    assert "\nenough          2\nnot enough      1, proved\n" in said
    assert "longest baseline" in said


def test_the_smallest_size_is_that_of_the_closed_form(capsys: pytest.CaptureFixture[str]):
    # sqrt(2) (s - 2) = 200 / 6.25 at s = 24.63 mm.
    assert run_command(["least", "size", "tolerance.mm=6.25", "precision=0.001", *SMALL]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if line.startswith("enough "))
    assert 24.627 / 40 <= float(line.split()[1].rstrip(":")) <= 1.001 * 24.628 / 40


def test_the_design_that_is_enough_is_saved_where_that_is_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    assert run_command(["least", "lenses", "rmse=5", "out=few/here", *SMALL]) == 0
    design = Design.load(tmp_path / "few" / "here" / "design.json")
    assert design.rmse <= 5
    assert (tmp_path / "few" / "here" / "run.log").read_text().startswith("multilens least lenses rmse=5 out=few/here ")


def test_what_nothing_reaches_ends_with_the_code_of_nothing_found(capsys: pytest.CaptureFixture[str]):
    assert run_command(["least", "lenses", "rmse=1", "most=2", *SMALL]) == 3
    told = capsys.readouterr()
    assert "nothing that was tried is enough" in told.out
    assert told.err == "multilens: nothing that was tried is enough for RMSE <= 1 mm\n"


def test_a_figure_is_that_of_the_metric(capsys: pytest.CaptureFixture[str]):
    assert run_command(["least", "lenses", "figure=5", *SMALL]) == 0
    assert "RMSE <= 5 mm" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "least must be told of what: lenses, size, aperture"),
        (["lens", "rmse=2"], "got lens; did you mean lenses?"),
        (["lenses"], "least must have a goal: rmse=2, figure=2, tolerance.mm=5 or tolerance.percent=1, got none"),
        (["lenses", "rmse=two"], "rmse must be a number > 0, got two"),
        (["lenses", "rmse="], "rmse must be a number > 0, got nothing"),
        (["lenses", "rmse=2", "most=65"], "most must be at most 64, got 65"),
        (["lenses", "rmse=2", "most=2.7"], "most must be a whole number of lenses, got 2.7"),
        (["lenses", "rmse=2", "rmse=3"], "rmse must be given once, got rmse=2 rmse=3"),
        (["lenses", "rmse=2", "out=here", "out=there"], "out must be given once, got out=here out=there"),
        (["aperture", "rmse=2", "most=3"], "most is no option of least aperture, got most=3"),
        (["lenses", "rmse=2", "figure=2"], "least must have one goal, rmse, figure or tolerance, got several"),
        (["lenses", "rmse=2", "tolerance.mm=2"], "least must have one goal"),
        (["lenses", "tolerance.mm=-2"], "tolerance: mm must be > 0 and finite, got -2"),
        (["lenses", "rmse=2", "out="], "out must be one folder, as in out=runs/fewest, got none"),
        (["lenses", "rmse=2", "lenses.cuont=3"], "did you mean lenses.count?"),
        (["aperture", "rmse=2", *SMALL], "least aperture: lenses must have apertures to choose from"),
        (["size", "rmse=2", "robust=assembly", *SMALL], "robust must be none: least asks of a device as it is drawn"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_one_line(words: list[str], told: str, capsys: pytest.CaptureFixture[str]):
    assert run_command(["least", *words]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert told in err


def test_a_folder_that_is_used_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "used").mkdir()
    (tmp_path / "used" / "file").touch()
    assert run_command(["least", "lenses", "rmse=2", "out=used"]) == 2
    assert "out must be a new or empty folder" in capsys.readouterr().err
