import pytest

from multilens.report.run_page import run_page
from multilens.report.write import estimates_in, write_report
from multilens.runs import write_run
from multilens.storage import ESTIMATES


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
