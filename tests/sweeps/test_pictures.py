from dataclasses import replace

import pytest

from multilens.runs import write_design
from multilens.sweep_row import SweepRow
from multilens.sweeps.job import row_of, write_job
from multilens.sweeps.locks import clear_half_written
from multilens.sweeps.pictures import draw_pictures

STEMS = {"count", "layouts", "front", "map"}


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    monkeypatch.setattr("multilens.plot.figures.DOTS_PER_INCH", 20)


@pytest.fixture
def sweep(tmp_path, design):
    """Four jobs of two keys, of which the last found nothing; what they tell of lenses and areas is made up."""
    folder = tmp_path / "sweep"
    folder.mkdir()
    for job in range(3):
        settings = (("back.outline.width", str(40 + job // 2)), ("lenses.count", str(2 + job % 2)))
        row = row_of(design, job, settings, 0.5)
        row = replace(row, lens_count=2 + job % 2, back_area=2400.0 + job)
        write_job(folder / str(job), "f", row, lambda inside: write_design(inside, design))
    nothing = SweepRow(3, (("back.outline.width", "41"), ("lenses.count", "3")), "infeasible", "no room")
    write_job(folder / "3", "f", nothing, lambda inside: None)
    return folder


def contents(folder):
    """Give every file but the locks, which are empty."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix != ".lock")
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_a_sweep_gets_its_pictures_and_nothing_else_is_touched(sweep):
    before = contents(sweep)
    pictures = draw_pictures(sweep)
    assert {path.name for path in pictures} == {f"{stem}.{kind}" for stem in STEMS for kind in ("svg", "png")}
    after = contents(sweep)
    assert {name: after[name] for name in before} == before
    assert set(after) - set(before) == {path.name for path in pictures}
    assert [path.name for path in sweep.parent.iterdir()] == ["sweep"]


class KilledError(BaseException):
    """Stands for a kill: nobody catches it."""


def test_what_a_kill_leaves_half_drawn_is_cleared_away(sweep, monkeypatch):
    def killed(figures, folder):
        (folder / "count.svg").write_text("<svg")
        raise KilledError

    before = contents(sweep)
    monkeypatch.setattr("multilens.plot.figures.save_figures", killed)
    monkeypatch.setattr("multilens.storage.shutil.rmtree", lambda folder, ignore_errors: None)
    with pytest.raises(KilledError):
        draw_pictures(sweep)
    monkeypatch.undo()
    assert contents(sweep) != before
    assert [path.name for path in sweep.parent.iterdir()] == ["sweep"]
    clear_half_written(sweep)
    assert contents(sweep) == before


def test_the_same_sweep_is_drawn_the_same(sweep):
    draw_pictures(sweep)
    before = contents(sweep)
    draw_pictures(sweep)
    assert contents(sweep) == before


def test_pictures_that_make_no_sense_any_more_go(sweep, design):
    draw_pictures(sweep)
    for job in ("1", "2", "3"):
        (sweep / job / "row.json").unlink()
    assert {path.stem for path in draw_pictures(sweep)} == {"layouts"}
    assert {path.stem for path in sweep.glob("*.png")} == {"layouts"}


def test_a_damaged_design_does_not_keep_the_others_from_their_pictures(sweep):
    (sweep / "0" / "design.json").write_text("{")
    (sweep / "1" / "design.json").unlink()
    assert {path.stem for path in draw_pictures(sweep)} == STEMS


def test_a_folder_without_jobs_has_no_pictures(tmp_path):
    assert draw_pictures(tmp_path) == ()
