import csv

import pytest

from multilens.table_text import csv_text, markdown_text


@pytest.mark.parametrize("value", [0.1, 1 / 3, 5e-324, 1.7976931348623157e308])
def test_a_float_reads_back_bit_for_bit(value):
    assert float(csv_text([[value]])) == value


def test_a_comma_or_a_quote_stays_in_its_cell():
    rows = [["a,b", 'say "c"', ""]]
    assert list(csv.reader(csv_text(rows).splitlines())) == rows


def test_a_bar_or_a_line_break_does_not_break_the_table_to_read():
    head, rule, row = markdown_text([["what"], ["no room | at\nall"]]).splitlines()
    assert (head, rule, row) == ("| what |", "| --- |", "| no room \\| at all |")


def test_what_is_unknown_is_an_empty_cell():
    assert markdown_text([["what"], [None]]).splitlines()[-1] == "|  |"
