import csv
import errno
import os
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest
from matplotlib.figure import Figure

from multilens.back import Back
from multilens.certificate import certify
from multilens.cues import PairStereo
from multilens.design import INFEASIBLE, Design
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.runs import redraw, write_run

TEXTS = {"config.yaml", "design.json", "layout.csv", "run.log", "sensitivity.csv"}
PICTURES = {f"{name}.{kind}" for name in ("layout", "overview") for kind in ("svg", "png")}


@pytest.fixture(scope="module")
def design():
    lens = Lens(5.0, (0.5, 2.0), (200, 5000), clearance=1.0)
    problem = Problem(Back.rectangle(40, 60), [lens, replace(lens, tiers=2)], [300.0, 900.0, 2000.0])
    layout = Layout([[5.1, 6.2], [35.1, 46.2]], [1.25, 2.0], [[300.3, 300.3], [900.9, 2000.1]])
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    return Design(problem, layout, "complete", "", certificate)


@pytest.fixture
def sketches(monkeypatch):
    """Pictures that cost nothing; `sketches.error` is raised after the first of them is written."""

    class Sketches(ModuleType):
        error: BaseException | None = None
        text = "a picture"

    module = Sketches("multilens.plot.figures")

    def save_figures(figures, folder):
        for name in figures:
            for kind in ("svg", "png"):
                (folder / f"{name}.{kind}").write_text(f"{module.text} of {name}")
                if module.error is not None:
                    raise module.error

    module.design_figures = lambda problem, layout, convergence, tolerance: {"layout": Figure()}
    module.overview_figure = lambda problem, layout, tolerance: Figure()
    module.save_figures = save_figures
    monkeypatch.setitem(sys.modules, "multilens.plot.figures", module)
    return module


def names(folder):
    return {path.name for path in folder.iterdir()}


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_a_run_leaves_exactly_its_files(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "seed: 0\n", "done\n")
    assert names(tmp_path) == {"run"}
    assert names(tmp_path / "run") == TEXTS | PICTURES


def test_a_run_keeps_config_and_log_as_they_were(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "seed: 0\nname: Müller\n", "done\n")
    assert (tmp_path / "run" / "config.yaml").read_bytes() == "seed: 0\nname: Müller\n".encode()
    assert (tmp_path / "run" / "run.log").read_text() == "done\n"


def test_the_design_of_a_run_is_the_one_that_was_written(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "", "")
    assert Design.load(tmp_path / "run" / "design.json").to_json() == design.to_json()


def test_the_same_run_leaves_the_same_bytes(tmp_path, design, sketches):
    for name in ("one", "two"):
        write_run(tmp_path / name, design, "seed: 0\n", "done\n")
    assert contents(tmp_path / "one") == contents(tmp_path / "two")


def test_the_layout_is_a_table_that_other_programs_read(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "", "")
    with (tmp_path / "run" / "layout.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows == [
        {
            "lens": "1",
            "x_mm": "5.1",
            "y_mm": "6.2",
            "aperture_radius_mm": "1.25",
            "f_number": "2.0",
            "focus_mm": "300.3",
            "body_radius_mm": "2.25",
            "focal_length_mm": "5.0",
            "name": "",
        },
        {
            "lens": "2",
            "x_mm": "35.1",
            "y_mm": "46.2",
            "aperture_radius_mm": "2.0",
            "f_number": "1.25",
            "focus_mm": "900.9;2000.1",
            "body_radius_mm": "3.0",
            "focal_length_mm": "5.0",
            "name": "",
        },
    ]


def test_a_run_goes_into_an_empty_folder(tmp_path, design, sketches):
    (tmp_path / "run").mkdir()
    write_run(tmp_path / "run", design, "", "")
    assert names(tmp_path / "run") == TEXTS | PICTURES


def test_a_run_is_not_written_over_another(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "the first", "")
    before = contents(tmp_path / "run")
    with pytest.raises(FileExistsError, match=r"^folder must be new or empty, got .*run$"):
        write_run(tmp_path / "run", design, "the second", "")
    assert contents(tmp_path / "run") == before


def test_an_infeasible_design_leaves_no_run(tmp_path, design, sketches):
    with pytest.raises(ValueError, match="no room"):
        write_run(tmp_path / "run", replace(design, status=INFEASIBLE, reason="no room"), "", "")
    assert not names(tmp_path)


class Lidar(PairStereo):
    """A cue of somebody else's."""


def test_a_foreign_cue_leaves_no_run(tmp_path, design, sketches):
    foreign = Problem(design.problem.back, design.problem.lenses, [300.0], cues=[Lidar()])
    with pytest.raises(TypeError, match="Lidar"):
        write_run(tmp_path / "run", replace(design, problem=foreign), "", "")
    assert not names(tmp_path)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(143), OSError(errno.ENOSPC, "full"), MemoryError()])
@pytest.mark.parametrize("there", [False, True], ids=["new", "empty"])
def test_a_run_that_ends_while_it_draws_leaves_nothing(tmp_path, design, sketches, error, there):
    if there:
        (tmp_path / "run").mkdir()
    sketches.error = error
    with pytest.raises(type(error)):
        write_run(tmp_path / "run", design, "", "")
    assert [path.name for path in tmp_path.rglob("*")] == ["run"] * there


def test_a_disk_that_fills_up_at_any_file_leaves_nothing(tmp_path, design, sketches, monkeypatch):
    flushes = 0

    def fills_up(handle):
        nonlocal flushes
        flushes -= 1
        if flushes < 0:
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", fills_up)
    for allowed in range(len(TEXTS | PICTURES)):
        flushes = allowed
        with pytest.raises(OSError, match="No space left"):
            write_run(tmp_path / "run", design, "", "")
        assert not names(tmp_path)


@pytest.mark.parametrize("file", sorted(TEXTS))
def test_a_text_that_cannot_be_written_leaves_nothing(tmp_path, design, sketches, monkeypatch, file):
    write_bytes = Path.write_bytes

    def fills_up(path, *given, **named):
        if path.name == file:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write_bytes(path, *given, **named)

    monkeypatch.setattr(Path, "write_bytes", fills_up)
    with pytest.raises(OSError, match="No space left"):
        write_run(tmp_path / "run", design, "", "")
    assert not names(tmp_path)


def test_redrawing_changes_the_pictures_alone(tmp_path, design, sketches):
    run = tmp_path / "run"
    write_run(run, design, "seed: 0\n", "done\n")
    before = contents(run)
    sketches.text = "a new picture"
    redraw(run)
    after = contents(run)
    assert {name for name in after if after[name] != before[name]} == PICTURES
    assert names(run) == TEXTS | PICTURES
    assert names(tmp_path) == {"run"}


def test_redrawing_needs_the_design_alone(tmp_path, design, sketches):
    design.save(tmp_path / "design.json")
    redraw(tmp_path)
    assert names(tmp_path) == PICTURES | {"design.json"}


def test_redrawing_a_damaged_design_names_the_file(tmp_path, sketches):
    (tmp_path / "design.json").write_text('{"schema": "multilens.design"')
    with pytest.raises(ValueError, match=r"design\.json: must be whole JSON"):
        redraw(tmp_path)
    assert names(tmp_path) == {"design.json"}


def test_redrawing_that_is_interrupted_keeps_the_old_pictures(tmp_path, design, sketches):
    write_run(tmp_path / "run", design, "", "")
    before = contents(tmp_path / "run")
    sketches.text, sketches.error = "a new picture", KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt):
        redraw(tmp_path / "run")
    assert contents(tmp_path / "run") == before
    assert names(tmp_path) == {"run"}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory, design):
    """A run with its real pictures."""
    folder = tmp_path_factory.mktemp("drawn") / "run"
    write_run(folder, design, "", "")
    return folder


def test_a_run_draws_its_pictures(drawn):
    pictures = names(drawn) - TEXTS
    kinds = {"svg": b"<?xml", "png": b"\x89PNG"}
    assert pictures == {f"{name}.{kind}" for name in ("layout", "errors", "overview") for kind in kinds}
    assert all((drawn / name).read_bytes().startswith(kinds[name[-3:]]) for name in pictures)


def test_a_run_redrawn_is_the_same_to_the_byte(drawn):
    before = contents(drawn)
    redraw(drawn)
    assert contents(drawn) == before
