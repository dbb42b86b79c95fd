from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.plot.placing import Box, Disc, Paper, around, leader_end, spread

ROUNDING = 1e-9


@given(st.lists(st.tuples(st.floats(0, 100), st.floats(1, 12)), min_size=1, max_size=9))
def test_spread_keeps_the_order_and_keeps_labels_apart(labels):
    wanted, widths = zip(*sorted(labels), strict=True)
    centres = spread(wanted, widths, 0.0, 110.0)
    assert centres is not None
    edges = [(centre - width / 2, centre + width / 2) for centre, width in zip(centres, widths, strict=True)]
    assert edges[0][0] >= -ROUNDING
    assert edges[-1][1] <= 110 + ROUNDING
    assert all(a[1] <= b[0] + ROUNDING for a, b in pairwise(edges))


def test_spread_leaves_alone_what_is_apart():
    assert spread([10, 50, 90], [10, 10, 10], 0, 100) == pytest.approx([10, 50, 90])


def test_spread_parts_twins_evenly():
    assert spread([50, 50], [10, 10], 0, 100) == pytest.approx([45, 55])


def test_spread_says_when_the_line_is_too_short():
    assert spread([50, 50], [60, 60], 0, 100) is None


def test_a_label_avoids_lenses_and_labels():
    paper = Paper(Box(50, 50, 100, 100), boxes=[Box(70, 50, 20, 10)], discs=[Disc(50, 50, 8)])
    box = paper.place(20, 10, list(around((50, 50), 8, 20, 10, 30)), (50, 50))
    assert not box.covers(Box(70, 50, 20, 10))
    assert box.distance(50, 50) >= 8


def test_a_label_stays_on_the_paper():
    edge = Box(50, 50, 100, 100)
    assert Paper(edge).place(30, 10, [(95, 50), (-5, 50)], (95, 50)).within(edge)


def test_the_preferred_place_is_taken_where_all_are_free():
    box = Paper(Box(50, 50, 100, 100)).place(10, 10, [(30, 30), (60, 60)], (30, 30))
    assert (box.x, box.y) == (30, 30)


@pytest.mark.parametrize(
    ("start", "end", "meets"),
    [((0, 0), (20, 20), True), ((0, 0), (3, 20), False), ((10, 0), (10, 20), True), ((0, 3), (20, 3), False)],
)
def test_a_line_meets_a_box_or_passes_it(start, end, meets):
    assert Box(10, 10, 6, 6).meets(start, end) == meets


def test_a_leader_ends_where_the_label_is_nearest():
    assert leader_end(Box(10, 10, 4, 2), (0, 10)) == (8, 10)
