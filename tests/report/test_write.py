import os

import pytest

from multilens.report.run_page import run_page
from multilens.report.sweep_page import sweep_page
from multilens.report.write import estimates_in, write_report
from multilens.runs import write_design, write_run
from multilens.storage import ESTIMATES
from multilens.sweeps.claim import CLAIM_FILE
from multilens.sweeps.job import row_of, write_job
from multilens.sweeps.locks import clear_half_written
from multilens.sweeps.table import read_rows


@pytest.fixture
def run(design, tmp_path, monkeypatch):
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    log = f"multilens\n{ESTIMATES}\n  back.outline: drawn\n  lenses: guessed\nfound\n  not one\n"
    write_run(tmp_path / "run", design, "name: phone\n", log)
    return tmp_path / "run"


def test_the_report_of_a_folder_is_put_into_it(run, design):
    assert write_report(run) == run / "report.html"
    text = (run / "report.html").read_text(encoding="utf-8")
    assert text == run_page(
        design, "name: phone\n", (run / "run.log").read_text(), "back.outline: drawn\nlenses: guessed"
    )


def test_the_report_of_a_design_needs_a_place(design, tmp_path):
    assert write_report(design, tmp_path / "design.html").read_text(encoding="utf-8") == run_page(design)
    with pytest.raises(ValueError, match="path must be given for the report of a design, got None"):
        write_report(design)


def test_a_folder_that_lost_its_words_still_has_a_report(run):
    (run / "run.log").unlink()
    (run / "config.yaml").unlink()
    assert "What the run said" not in write_report(run).read_text(encoding="utf-8")


def test_a_damaged_design_is_refused_and_an_older_report_stays(run):
    before = write_report(run).read_bytes()
    text = (run / "design.json").read_text().replace("200.0", "201.0")
    (run / "design.json").write_text(text)
    with pytest.raises(ValueError, match=r"design\.json: checksum must be"):
        write_report(run)
    assert (run / "report.html").read_bytes() == before


def test_estimates_are_those_lines_of_a_log_that_follow_their_head():
    assert estimates_in(f"a\n{ESTIMATES}\n  b: c\nd\n  e\n") == "b: c"
    assert estimates_in("a\n  b\n") == ""


@pytest.fixture
def sweep(design, tmp_path):
    for job in (0, 1):
        row = row_of(design, job, (("search.seed", str(job)),), 1.0)
        write_job(tmp_path / str(job), "", row, lambda inside: write_design(inside, design))
    return tmp_path


def test_the_report_of_a_sweep_is_put_into_its_folder(sweep, design):
    said = []
    assert write_report(sweep, listener=said.append) == sweep / "report.html"
    assert (sweep / "report.html").read_text(encoding="utf-8") == sweep_page(read_rows(sweep), {0: design, 1: design})
    assert said == ["reading designs: 0 of 2", "reading designs: 1 of 2", "drawing charts and layouts"]


def test_the_report_is_not_cleared_away_by_the_sweep_while_it_is_written(sweep, monkeypatch):
    replace = os.replace

    def clear_and_replace(written, path):
        clear_half_written(sweep)
        replace(written, path)

    (sweep / CLAIM_FILE).write_text("{}")
    monkeypatch.setattr("os.replace", clear_and_replace)
    write_report(sweep)


def test_no_lock_is_left_in_the_folder_of_a_run(run):
    before = {*run.iterdir()}
    write_report(run)
    assert {*run.iterdir()} - before == {run / "report.html"}


def test_a_design_of_a_sweep_that_cannot_be_read_is_told(sweep):
    (sweep / "1" / "design.json").write_text("{}")
    text = write_report(sweep).read_text(encoding="utf-8")
    assert '<td class="words">design.json: schema must be multilens.design, got None</td>' in text


def test_a_folder_of_nothing_is_refused(tmp_path):
    with pytest.raises(OSError, match=r"must hold a design\.json or the jobs of a sweep"):
        write_report(tmp_path)
