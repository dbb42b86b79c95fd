"""Labels beside points of axes, of which none covers another, a point or the edge."""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from multilens.plot.canvas import POINTS_PER_INCH, paper_size, text_size
from multilens.plot.placing import Box, Disc, Paper, around, leader_end
from multilens.plot.style import FAINT, SMALL_FONT_SIZE

LINE_COST = 1.0
"""Of covering a line: less than the way to a place some rings farther out."""

LEADER = 9.0
"""Points between a label and its point from which on a thin line joins them."""


class Labels:
    """What stands on axes already, and room for labels beside it; the limits, scales and size of the axes must be final.

    Args:
        axes: written on.
    """

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.width, self.height = paper_size(axes)
        self._paper = Paper(Box(self.width / 2, self.height / 2, self.width, self.height))

    def paper(self, x: float, y: float) -> tuple[float, float]:
        """Give the place of a point of the data, points from the top left corner of the axes."""
        box, dpi = self.axes.get_window_extent(), self.axes.get_figure(root=True).dpi  # pyright: ignore[reportOptionalMemberAccess] axes drawn on have a figure
        across, up = self.axes.transData.transform((x, y))
        return float((across - box.x0) * POINTS_PER_INCH / dpi), float((box.y1 - up) * POINTS_PER_INCH / dpi)

    def keep_off(self, x: float, y: float, radius: float) -> None:
        """Keep every label off a mark of so many points radius."""
        self._paper.discs.append(Disc(*self.paper(x, y), radius))

    def rather_not_on(self, places: Sequence[tuple[float, float]]) -> None:
        """Keep labels off a line through these points of the data where there is room beside it."""
        corners = [self.paper(*place) for place in places]
        for start, end in pairwise(corners):
            self._paper.soft.append(partial(_cost_of_line, start, end))

    def rather_not_on_points(self, places: Sequence[tuple[float, float]]) -> None:
        """Keep labels off these points of the data where there is room beside them."""
        if places:
            self._paper.soft.append(partial(_cost_of_points, np.array([self.paper(*place) for place in places])))

    def write(self, x: float, y: float, words: str, radius: float = 4.0, reach: float = 60.0, **look: Any) -> bool:
        """Write words beside a point of the data, or nothing where there is no room; give whether they were written.

        Args:
            x: of the point, in the data.
            y: of the point, in the data.
            words: one line.
            radius: of the mark at the point, points.
            reach: how far off the words may be, points.
            look: of the text.
        """
        look = {"fontsize": SMALL_FONT_SIZE} | look
        width, height = text_size(self.axes, words, **look)
        anchor = self.paper(x, y)
        free = [
            place
            for place in around(anchor, radius, width, height, reach)
            if self._paper.hard_cost(Box(*place, width, height)) == 0
        ]
        if not free:
            return False
        box = self._paper.place(width, height, free, anchor)
        self._join(box, anchor, radius)
        place = {"transform": self.axes.transAxes, "ha": "center", "va": "center", "parse_math": False, "zorder": 10}
        self.axes.text(box.x / self.width, 1 - box.y / self.height, words, **(place | look))
        return True

    def _join(self, box: Box, anchor: tuple[float, float], radius: float) -> None:
        end = leader_end(box, anchor)
        length = hypot(end[0] - anchor[0], end[1] - anchor[1])
        if length > radius + LEADER:
            share = radius / length
            start = (anchor[0] + share * (end[0] - anchor[0]), anchor[1] + share * (end[1] - anchor[1]))
            x, y = ([a / self.width for a in (start[0], end[0])], [1 - b / self.height for b in (start[1], end[1])])
            self.axes.plot(x, y, transform=self.axes.transAxes, color=FAINT, linewidth=0.6, zorder=7)


def _cost_of_points(points: Float[np.ndarray, "n 2"], box: Box) -> float:
    apart = np.abs(points - (box.x, box.y)) < (box.width / 2, box.height / 2)
    return LINE_COST * float(apart.all(axis=1).sum())


def _cost_of_line(start: tuple[float, float], end: tuple[float, float], box: Box) -> float:
    return LINE_COST * box.meets(start, end)
