import errno
import os
from math import pi

import pytest

from multilens.runs import write_design, write_words
from multilens.sweep_row import SweepRow
from multilens.sweeps.job import read_job, refuse_damaged, row_of, write_job

ROW = SweepRow(3, (("lenses.count", "9"),), "infeasible", "no room")


def words(folder):
    write_words(folder, "seed: 0\n", "sorry\n")


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_a_job_that_found_nothing_leaves_its_row_and_its_words(tmp_path):
    write_job(tmp_path / "3", "f", ROW, words)
    assert names(tmp_path / "3") == {"config.yaml", "run.log", "row.json", "time.json"}
    assert names(tmp_path) == {"3"}


def test_a_row_reads_back_with_its_fingerprint(tmp_path):
    write_job(tmp_path / "3", "f", ROW, words)
    sealed = read_job(tmp_path / "3")
    assert (sealed.fingerprint, sealed.row) == ("f", ROW)


def test_a_folder_as_it_was_written_is_whole(tmp_path):
    write_job(tmp_path / "3", "f", ROW, words)
    refuse_damaged(tmp_path / "3", read_job(tmp_path / "3"))


def test_a_picture_that_was_added_does_no_damage(tmp_path):
    write_job(tmp_path / "3", "f", ROW, words)
    (tmp_path / "3" / "layout.svg").write_text("a picture")
    refuse_damaged(tmp_path / "3", read_job(tmp_path / "3"))


@pytest.mark.parametrize(
    ("damage", "told"), [("seed: 1\n", "config.yaml was altered"), ("", "altered"), (None, "config.yaml is missing")]
)
def test_damage_is_told_by_the_file(tmp_path, damage, told):
    write_job(tmp_path / "3", "f", ROW, words)
    config = tmp_path / "3" / "config.yaml"
    config.unlink() if damage is None else config.write_text(damage)
    with pytest.raises(ValueError, match=told):
        refuse_damaged(tmp_path / "3", read_job(tmp_path / "3"))


def test_an_altered_row_is_refused(tmp_path):
    write_job(tmp_path / "3", "f", ROW, words)
    row = tmp_path / "3" / "row.json"
    row.write_text(row.read_text().replace("no room", "no time"))
    with pytest.raises(ValueError, match="checksum"):
        read_job(tmp_path / "3")


def test_a_disk_that_fills_up_leaves_nothing(tmp_path, monkeypatch):
    def fills_up(handle):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", fills_up)
    with pytest.raises(OSError, match="No space left"):
        write_job(tmp_path / "3", "f", ROW, words)
    assert not names(tmp_path)


def test_a_design_is_sealed_with_its_row(tmp_path, design):
    def files(folder):
        write_design(folder, design)

    write_job(tmp_path / "3", "f", row_of(design, 3, (), 0.5), files)
    assert read_job(tmp_path / "3").checksums.keys() == {"design.json", "layout.csv", "sensitivity.csv"}


def test_a_row_holds_what_a_design_is(design):
    row = row_of(design, 3, (("depth", "room"),), 0.5)
    assert (row.job, row.settings, row.status, row.lens_count) == (3, (("depth", "room"),), "complete", 2)
    assert (row.metric, row.unit, row.measured, row.time) == ("RMSE", "mm", 1.0, 0.5)
    assert row.score == design.score
    assert (row.bound, row.gap) == (None, None)


def test_the_areas_and_the_baseline_of_a_row_are_those_of_discs_on_a_rectangle(design):
    # Radii 1.25 and 2 mm, bodies 1 mm wider, 30 and 40 mm apart on 40 by 60 mm.
    row = row_of(design, 3, (), 0.5)
    assert row.aperture_area == pytest.approx(pi * (1.25**2 + 2**2), rel=1e-12)
    assert row.body_area == pytest.approx(pi * (2.25**2 + 3**2), rel=1e-12)
    assert row.back_area == 2400
    assert row.longest_baseline == 50
