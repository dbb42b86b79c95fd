"""A tolerance and where it is kept, on the picture of the errors."""

from typing import Any

import numpy as np
import torch
from matplotlib.axes import Axes

from multilens.layout import Layout
from multilens.metrics import as_quoted
from multilens.plot.style import KEPT, SMALL_FONT_SIZE
from multilens.problem import Problem
from multilens.tolerance import Tolerance
from multilens.working_range import allowed_error, working_range

BAR = 0.022
"""Height of the bar, as a part of the picture's."""


def draw_tolerance(ax: Axes, problem: Problem, layout: Layout, tolerance: Tolerance, above: float = 24.0) -> None:
    """Draw the error that is allowed as a dotted line, and a bar along the foot at the depths whose error is within it.

    Args:
        ax: with the errors on it; its limits stay.
        problem: what is asked.
        layout: one layout, not a batch.
        tolerance: largest error.
        above: points between the curves and the words: room for the legend.
    """
    near, far = ax.get_xlim()
    depths = torch.from_numpy(np.geomspace(near, far, 256))
    allowed = as_quoted(problem.metric, allowed_error(tolerance, depths), depths)
    ax.plot(depths, allowed, color=KEPT, linewidth=1.4, linestyle=(0, (1, 1.5)), zorder=4)
    for begin, end in working_range(problem, layout, tolerance).intervals:
        ax.axvspan(begin, end, 0, BAR, facecolor=KEPT, edgecolor="none", zorder=5)
    # Above the legend, where no curve is.
    place: dict[str, Any] = {"textcoords": "offset points", "xycoords": "axes fraction", "ha": "left", "va": "bottom"}
    words = f"dots and bar: error at most {tolerance}"
    ax.annotate(words, (0, 1), xytext=(6, above), color=KEPT, fontsize=SMALL_FONT_SIZE, parse_math=False, **place)
