from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from multilens.plot.labels import Labels
from multilens.plot.style import style


def axes():
    ax = Figure(figsize=(4, 3)).add_axes((0.1, 0.1, 0.8, 0.8))
    ax.set(xlim=(0, 10), ylim=(0, 10))
    return ax


def test_a_place_on_the_paper_is_told_from_the_top_left():
    labels = Labels(axes())
    assert labels.paper(0, 10) == pytest.approx((0, 0))
    assert labels.paper(10, 0) == pytest.approx((0.8 * 4 * 72, 0.8 * 3 * 72))


@given(st.lists(st.tuples(st.floats(0, 10), st.floats(0, 10)), min_size=1, max_size=12))
def test_labels_cover_neither_each_other_nor_marks_nor_the_edge(places):
    with style():
        ax = axes()
        labels = Labels(ax)
        for place in places:
            labels.keep_off(*place, 3.0)
        written = [labels.write(*place, "label") for place in places]
    edge, boxes = ax.get_window_extent(), [text.get_window_extent() for text in ax.texts]
    assert len(boxes) == sum(written)
    for box in boxes:
        assert edge.x0 <= box.x0 < box.x1 <= edge.x1
        assert edge.y0 <= box.y0 < box.y1 <= edge.y1
        assert not any(box.contains(*ax.transData.transform(place)) for place in places)
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))


def test_what_finds_no_room_is_not_written():
    ax = axes()
    labels = Labels(ax)
    labels.keep_off(5, 5, 1000.0)
    assert not labels.write(5, 5, "label", reach=20.0)
    assert not ax.texts


def test_a_label_keeps_off_a_line_where_it_can():
    ax = axes()
    labels = Labels(ax)
    labels.rather_not_on([(5, 5), (10, 5)])
    labels.write(5, 5, "label")
    box = ax.texts[0].get_window_extent()
    (_, y) = ax.transData.transform((5, 5))
    assert not (box.y0 < y < box.y1 and box.x1 > ax.transData.transform((5, 5))[0])
