import json

import pytest

from multilens.sweep_row import SweepRow, cells, in_order, read_row

FOUND = SweepRow(
    3, (("lenses.count", "2"), ("depth", "room")), "complete", lens_count=2, metric="RMSE", figure=0.1, rmse=0.1
)
FAILED = SweepRow(4, (("lenses.count", "9"),), "infeasible", "no room")


@pytest.mark.parametrize("row", [FOUND, FAILED])
def test_a_row_reads_back_from_json(row):
    assert read_row(json.loads(json.dumps(row.record())), "row") == row


def test_a_column_says_its_unit():
    assert {"rmse_mm", "longest_baseline_mm", "aperture_area_mm2", "time_s"} <= FOUND.record().keys()


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("job", "3", "row.job must be a whole number, got '3'"),
        ("status", 1, "row.status must be a text, got 1"),
        ("rmse_mm", "small", "row.rmse_mm must be a number, got 'small'"),
        ("lens_count", 2.5, "row.lens_count must be a whole number, got 2.5"),
        ("settings", [], "row.settings must be a record"),
        ("settings", {"depth": 1}, "row.settings.depth must be a text, got 1"),
        ("colour", "red", "unknown key 'colour'"),
    ],
)
def test_a_row_of_another_kind_is_refused_by_its_key(key, value, told):
    with pytest.raises(ValueError, match=told):
        read_row(FOUND.record() | {key: value}, "row")


def test_a_table_has_a_column_for_every_key_that_was_swept():
    head, found, failed = cells([FOUND, FAILED])
    assert head[:4] == ["job", "lenses.count", "depth", "status"]
    assert found[:4] == [3, "2", "room", "complete"]
    assert failed[:4] == [4, "9", None, "infeasible"]


def test_a_swept_key_with_the_name_of_a_column_has_a_column_of_its_own():
    head, line = cells([SweepRow(0, (("metric", "relative"),), "complete", metric="relative RMSE")])
    assert dict(zip(head, line, strict=True)) | {"metric=": "relative", "metric": "relative RMSE"} == dict(
        zip(head, line, strict=True)
    )
    assert len(set(head)) == len(head)


def test_a_line_of_a_table_is_as_long_as_its_head():
    assert {len(line) for line in cells([FOUND, FAILED])} == {len(cells([])[0]) + 2}


@pytest.mark.parametrize(
    ("values", "ordered"),
    [
        (["10", "9", "-1e1", "9"], ["-1e1", "9", "10"]),
        (["room", "near", "room"], ["room", "near"]),
        (["9", "null", "1"], ["9", "null", "1"]),
    ],
)
def test_numbers_are_in_order_by_size_and_words_as_they_come(values, ordered):
    assert in_order(values) == ordered
