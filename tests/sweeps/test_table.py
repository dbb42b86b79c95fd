import csv
import json

import pytest

from multilens.sweep_row import SweepRow
from multilens.sweeps.job import row_of, write_job
from multilens.sweeps.table import read_rows, without_empty_columns, write_tables


@pytest.fixture
def sweep(tmp_path, design):
    for job in (0, 10, 2):
        row = row_of(design, job, (("lenses.count", str(job)), ("depth", "room")), 0.5)
        write_job(tmp_path / str(job), "f", row, lambda folder: None)
    nothing = SweepRow(3, (("lenses.count", "9"), ("gap", "[1,2]")), "infeasible", "no room | at all")
    write_job(tmp_path / "3", "f", nothing, lambda folder: None)
    (tmp_path / "4").mkdir()
    (tmp_path / "5").mkdir()
    (tmp_path / "5" / "row.json").write_text("{")
    (tmp_path / ".6.partial-0000").mkdir()
    (tmp_path / "7").write_text("no folder")
    return tmp_path


def test_rows_are_gathered_in_the_order_of_their_jobs(sweep):
    assert [(row.job, row.status) for row in read_rows(sweep)] == [
        (0, "complete"),
        (2, "complete"),
        (3, "infeasible"),
        (5, "unreadable"),
        (10, "complete"),
    ]


@pytest.mark.parametrize("damage", ['{"status": "infeasible"}', "[" * 100_000, "[1]", "\x00"])
def test_a_damaged_row_does_not_keep_the_others_from_the_table(sweep, damage):
    (sweep / "3" / "row.json").write_text(damage)
    rows = read_rows(sweep)
    assert [row.status for row in rows][1:3] == ["complete", "unreadable"]
    assert "\n" not in rows[2].reason


def test_the_table_for_programs_has_every_digit(sweep, design):
    write_tables(sweep)
    with (sweep / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["lenses.count"] for row in rows] == ["0", "2", "9", "", "10"]
    assert rows[2]["gap"] == "[1,2]"
    assert float(rows[1]["score"]) == design.score


def test_each_line_of_json_is_a_row(sweep):
    write_tables(sweep)
    lines = [json.loads(line) for line in (sweep / "table.jsonl").read_text().splitlines()]
    assert [line["job"] for line in lines] == [0, 2, 3, 5, 10]
    assert lines[0]["settings"] == {"lenses.count": "0", "depth": "room"}


def test_the_table_to_read_is_a_table(sweep):
    write_tables(sweep)
    head, rule, *rows = (sweep / "table.md").read_text().splitlines()
    assert {line.replace(r"\|", "").count("|") for line in (head, rule, *rows)} == {head.count("|")}
    assert "no room \\| at all" in rows[2]


def test_what_is_empty_in_every_row_takes_no_room_where_people_read():
    assert without_empty_columns([["a", "b", "c"], [1, None, ""], [2, "x", None]]) == [["a", "b"], [1, None], [2, "x"]]
