"""A figure with a head that is as high as its words need, and axes placed in inches below it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from textwrap import wrap
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from multilens.plot.canvas import POINTS_PER_INCH
from multilens.plot.style import FAINT, FONT_SIZE, INK, SMALL_FONT_SIZE, TITLE_FONT_SIZE

LEFT = 0.35
"""Inches between the edge of the paper and its words."""

TITLE, NOTE, KEY = 0.62, 0.22, 0.24
"""Inches that the title takes from the top, and each line of the notes and of the key below it."""

SHEET_WIDTH, WIDE_WIDTH = 9.0, 13.333
"""Inches: of a picture of one panel, and of several."""

LEFT_OF_AXES, ABOVE_AXES, RIGHT_OF_AXES = 0.9, 0.36, 0.25
"""Inches around a panel for its numbers and words."""

FOOT = 0.2
"""Inches at the foot for a remark."""

LETTER = 0.082
"""Width of a letter of a note, inches, as they are on average; a little more."""

HANDLE = 50.0
"""Points that the sign of an entry of the key takes, with the space to the next entry."""


@dataclass(frozen=True)
class Sheet:
    """A figure whose head is drawn.

    Args:
        figure: drawn on.
        head: that its title, notes and key take, inches.
    """

    figure: Figure
    head: float

    def axes(self, left: float, top: float, width: float, height: float) -> Axes:
        """Add axes at inches from the left edge and from the foot of the head."""
        across, up = self.figure.get_size_inches()
        bottom = up - self.head - top - height
        return self.figure.add_axes((left / across, bottom / up, width / across, height / up))

    def panel(self, row: int, column: int, columns: int, height: float, below: float, title: str) -> Axes:
        """Add one of a grid of axes, each so many inches high, with so many below it and a title above it."""
        each = (self.figure.get_size_inches()[0] - 0.1) / columns
        top = row * (ABOVE_AXES + height + below) + ABOVE_AXES
        ax = self.axes(column * each + LEFT_OF_AXES, top, each - LEFT_OF_AXES - RIGHT_OF_AXES, height)
        ax.set_title(title, fontsize=FONT_SIZE, loc="left", pad=7.0, parse_math=False)
        return ax

    def say_below(self, words: str) -> None:
        """Write a remark in the lower right corner."""
        look = {"ha": "right", "va": "bottom", "color": FAINT, "parse_math": False}
        self.figure.text(0.99, 0.06 / self.figure.get_size_inches()[1], words, fontsize=0.8 * SMALL_FONT_SIZE, **look)


def width_for(columns: int) -> float:
    """Give the width of a figure with so many panels side by side, inches."""
    return SHEET_WIDTH if columns == 1 else WIDE_WIDTH


def sheet(width: float, below: float, title: str, notes: Sequence[str] = (), key: Sequence[Artist] = ()) -> Sheet:
    """Make a figure with a title, notes and a key.

    Args:
        width: of the figure, inches.
        below: what is needed below the head, inches.
        title: one line.
        notes: each wrapped to the width; empty ones are left out.
        key: signs with their labels.
    """
    lines = [line for note in notes for line in wrap(note, int((width - 2 * LEFT) / LETTER))]
    figure = Figure(figsize=(width, below))
    columns = _columns(figure, key)
    under_title = TITLE + NOTE * len(lines)
    head = under_title + (KEY * ceil(len(key) / columns) + 0.05 if key else 0.0) + 0.12
    height = head + below + FOOT
    figure.set_size_inches(width, height)
    look = {"ha": "left", "parse_math": False}
    figure.text(LEFT / width, 1 - 0.5 / height, title, fontsize=TITLE_FONT_SIZE, **look)
    for k, line in enumerate(lines):
        y = 1 - (TITLE + NOTE * (k + 0.6)) / height
        figure.text(LEFT / width, y, line, fontsize=FONT_SIZE - 1.5, color=FAINT, **look)
    if key:
        place: dict[str, Any] = {
            "loc": "upper left",
            "bbox_to_anchor": ((LEFT - 0.02) / width, 1 - under_title / height),
            "ncols": columns,
        }
        space: dict[str, Any] = {
            "borderaxespad": 0.0,
            "borderpad": 0.2,
            "columnspacing": 1.6,
            "handlelength": 2.2,
            "labelspacing": 0.4,
        }
        legend = figure.legend(handles=list(key), frameon=False, fontsize=SMALL_FONT_SIZE, **place, **space)
        for text in legend.get_texts():
            text.set_parse_math(False)
    return Sheet(figure, head)


def _columns(figure: Figure, key: Sequence[Artist]) -> int:
    """Give how many entries of a key stand side by side."""
    widest = max((_width(figure, str(entry.get_label())) for entry in key), default=0.0)
    room = (figure.get_size_inches()[0] - 2 * LEFT) * POINTS_PER_INCH
    return max(1, min(len(key), int(room / (widest + HANDLE))))


def _width(figure: Figure, words: str) -> float:
    text = figure.text(0, 0, words, fontsize=SMALL_FONT_SIZE, parse_math=False, color=INK)
    width = text.get_window_extent().width * POINTS_PER_INCH / figure.dpi
    text.remove()
    return float(width)
