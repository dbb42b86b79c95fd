"""`back=file`: a back from a drawing, by whole command lines and by their configurations."""

from pathlib import Path

import jaxtyping
import pytest
import yaml

from multilens.app.back_file import told_of_file
from multilens.app.build import build_back
from multilens.app.command import run_command
from multilens.app.given import read_given
from multilens.app.schema_file import sha256_of
from multilens.back import Back
from multilens.cad.export import export
from multilens.cad.read import LARGEST_FILE
from multilens.design import Design
from multilens.geometry.shape import disc

BACK = Back.rounded_rectangle(40, 60, corner=6).keep_out("flash", disc((20, 10), 2), clearance=0.5)
QUICK = ["lenses=unit", "cues=stereo", "depth.count=2", "search.starts=2", "search.patience=0", "search.proof=0"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    export(BACK, "phone.svg")


def read(*words: str) -> Back:
    return build_back(read_given(["back=file", *words]).config.back)


def test_a_back_is_read_from_where_the_command_runs():
    assert read("back.file.path=phone.svg") == BACK


def test_keep_outs_of_the_configuration_come_on_top(tmp_path: Path):
    (tmp_path / "presets" / "back").mkdir(parents=True)
    logo = "keep_outs: {logo: {shape: {kind: disc, radius: 3}}}"
    (tmp_path / "presets" / "back" / "mine.yaml").write_text(f"file: {{path: phone.svg}}\n{logo}\n")
    back = build_back(read_given(["--config-dir", "presets", "back=mine"]).config.back)
    assert [keep_out.name for keep_out in back.keep_outs] == ["flash", "logo"]


def test_layers_units_clearance_and_tolerance_are_told_by_keys():
    Path("phone.wkt").write_text("POLYGON ((0 0, 4 0, 4 6, 0 6, 0 0))\nPOLYGON ((1 1, 2 1, 2 2, 1 1))")
    back = read("back.file.path=phone.wkt", "back.file.units=cm", "back.file.clearance=0.25")
    assert back.outline.bounds == (0, -60, 40, 0)
    assert back.keep_outs[0].clearance == 0.25
    assert (
        read("back.file.path=phone.wkt", "back.file.units=mm", "back.file.keep_outs=[outline]").keep_outs[0].name
        == "outline"
    )


def test_no_layers_of_keep_outs_are_none():
    assert read("back.file.path=phone.svg", "back.file.keep_outs=[]") == Back(BACK.outline)


def test_a_checksum_is_of_files_alone_that_are_small_enough_to_be_read():
    with Path("huge.svg").open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    assert sha256_of("huge.svg") is None
    assert sha256_of(".") is None
    assert sha256_of("away.svg") is None


def test_a_run_says_what_it_read_and_keeps_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    words = ["back=file", "back.file.path=phone.svg", "hydra.run.dir=run", *QUICK]
    monkeypatch.setattr("sys.argv", ["multilens", *words])
    assert run_command(words) == 0
    said = "back from phone.svg:\n  outline: 40 x 60 mm, from (0, 0) to (40, 60)\n  keep-outs: flash\n"
    assert said in capsys.readouterr().out
    assert said in Path("run/run.log").read_text()
    assert Design.load("run/design.json").problem.back == BACK
    assert len(yaml.safe_load(Path("run/config.yaml").read_text())["back"]["file"]["sha256"]) == 64


def test_a_design_is_not_lost_with_its_drawing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    from multilens.app import searched

    real = searched.search

    def search_and_lose(*given: object, **more: object) -> Design:
        Path("phone.svg").write_text("something else")
        return real(*given, **more)  # pyright: ignore[reportArgumentType] -- what was given is handed on

    monkeypatch.setattr(searched, "search", search_and_lose)
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    words = ["back=file", "back.file.path=phone.svg", "hydra.run.dir=run", *QUICK]
    before = sha256_of("phone.svg")
    monkeypatch.setattr("sys.argv", ["multilens", *words])
    assert run_command(words) == 0, capsys.readouterr().err
    assert Design.load("run/design.json").problem.back == BACK
    assert yaml.safe_load(Path("run/config.yaml").read_text())["back"]["file"]["sha256"] == before


def test_a_file_that_has_changed_since_is_refused(capsys: pytest.CaptureFixture[str]):
    kept = read_given(["back=file", "back.file.path=phone.svg"]).config.back.file.sha256
    export(Back.disc(20), "phone.svg", overwrite=True)
    assert run_command(["evaluate", "back=file", "back.file.path=phone.svg", f"back.file.sha256={kept}"]) == 2
    told = capsys.readouterr().err
    assert "back.file.sha256 must be" in told
    assert f"that of phone.svg as it is now, got {kept}" in told


def test_nothing_is_told_where_no_file_is_read():
    assert told_of_file(read_given([]).config.back.file) == ""


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["back=file"], "back must have an outline, or a file of one as in back.file.path=phone.dxf, got neither"),
        (["back.file.path=phone.svg"], "back must have an outline or a file, got both: begin with back=file"),
        (["back.file.units=mm"], "back.file.units is of a file: set back.file.path, too, or none of them"),
        (["back=file", "back.file.path=/dev/zero"], "back.file.path must be a file, there is none at /dev/zero"),
        (["back=file", "back.file.path=huge.svg"], f"file must be at most {LARGEST_FILE} bytes, got more"),
        (
            ["back=file", "back.file.path=huge.svg", "back.file.sha256=0"],
            f"file must be at most {LARGEST_FILE} bytes, got more",
        ),
        (["back=file", "back.file.path=away.svg"], "back.file.path must be a file, there is none at away.svg"),
        (["back=file", "back.file.path=phone.step"], "back.file.path must be a file, there is none at phone.step"),
        (["back=file", "back.file.path=x.wkt"], "back.file: x.wkt: units must be known, got a file without them"),
        (
            ["back=file", "back.file.path=phone.svg", "back.file.layer=A"],
            "unknown key back.file.layer, back.file takes path, units",
        ),
        (
            ["back=file", "back.file.path=phone.svg", "back.file.outline=rim"],
            "layer rim of the outline must hold closed curves",
        ),
        (
            ["back=file", "back.file.path=phone.svg", "back.file.clearance=-1"],
            "clearance must be >= 0 and finite, got -1",
        ),
        (
            ["back=file", "back.file.path=phone.svg", "back.file.tolerance=0"],
            "tolerance must be > 0 and at most 10 mm, got 0",
        ),
        (["back=file", "back.file.path=bow.wkt", "back.file.units=mm"], "Self-intersection[5 5]"),
        (["back=file", "back.file.path=notes.txt"], "back.file: notes.txt must end in one of .dxf"),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_line_and_leaves_nothing(
    words: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    Path("x.wkt").write_text("POLYGON ((0 0, 4 0, 4 6, 0 6, 0 0))")
    Path("bow.wkt").write_text("POLYGON ((0 0, 10 10, 10 0, 0 10, 0 0))")
    with Path("huge.svg").open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    Path("notes.txt").write_text("4 x 6")
    monkeypatch.setattr("sys.argv", ["multilens", *words])
    assert run_command(words) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert told in err
    assert not (tmp_path / "runs").exists()
