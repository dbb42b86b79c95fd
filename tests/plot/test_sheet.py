import pytest
from matplotlib.lines import Line2D

from multilens.plot.sheet import FOOT, sheet
from multilens.plot.style import style


def key(count):
    return [Line2D([], [], label=f"one of many entries, number {k}") for k in range(count)]


@pytest.mark.parametrize("entries", [0, 1, 30])
@pytest.mark.parametrize("notes", [[], ["short", "", "word " * 100]])
def test_head_and_panels_keep_apart(clear, entries, notes):
    with style():
        page = sheet(9.0, 4.0, "A title", notes, key(entries))
        ax = page.panel(0, 0, 1, 3.0, 0.6, "a panel")
        clear(page.figure)
    lowest = min((legend.get_window_extent().y0 for legend in page.figure.legends), default=float("inf"))
    assert ax.get_window_extent().y1 < min([lowest, *(text.get_window_extent().y0 for text in page.figure.texts)])


def test_axes_have_the_inches_that_were_asked_for():
    page = sheet(9.0, 4.0, "A title", ["a note"])
    box = page.panel(0, 1, 2, 3.0, 0.6, "a panel").get_window_extent()
    assert box.height / page.figure.dpi == pytest.approx(3.0)
    assert box.y0 / page.figure.dpi == pytest.approx(4.0 - 3.0 - 0.36 + FOOT, abs=1e-6)


def test_axes_below_the_head_end_above_the_foot():
    page = sheet(9.0, 4.0, "A title", ["a note"], key(3))
    assert page.axes(0.0, 0.0, 9.0, 4.0).get_window_extent().y0 / page.figure.dpi == pytest.approx(FOOT)
