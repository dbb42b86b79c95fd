"""How the starts of a search came down to the design."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from multilens.convergence import Convergence
from multilens.metrics import Metric
from multilens.plot.axis import draw_grid, tick_in_plain_numbers
from multilens.plot.style import FAINT, INK, LENS_COLOURS, SMALL_FONT_SIZE
from multilens.plot.units import significant

START, BEST = "#9db4c8", LENS_COLOURS[0]

ROOM_AT_RIGHT = 0.06
"""Of the steps, for the marks of the polished starts."""


def draw_convergence(ax: Axes, convergence: Convergence, score: float, metric: Metric | None = None) -> None:
    """Draw the metric's figure of every start at every step, those that were polished as marks, and the design's.

    In the first steps of a start its lenses may still overlap or leave the back, so that its error may be less than any that is
    possible; the axis says so. The design may be better than every start: it may be a variation of one. A score of one's
    own is drawn itself.

    Args:
        ax: drawn on.
        convergence: of the starts.
        score: of the design.
        metric: how scores read; None for a score of one's own.
    """
    # Every metric's figure is the root of its score, or a fixed part of it.
    part = 1.0 if metric is None else metric.figure(1.0)
    scores = convergence.scores.detach().double().cpu().numpy(), np.array(convergence.polished_scores), np.array(score)
    heights, polished, final = (each if metric is None else part * np.sqrt(each) for each in scores)
    ax.plot(convergence.steps, heights.T, color=START, linewidth=0.6, alpha=0.6, zorder=1)
    feasible = np.isfinite(polished)
    best = convergence.polished[int(np.nanargmin(polished))] if feasible.any() else _lowest(heights)
    if best is not None:
        ax.plot(convergence.steps, heights[best], color=BEST, linewidth=2.4, zorder=3)
    last = max(convergence.steps)
    right = last + ROOM_AT_RIGHT * max(last, 1)
    marks = np.full(int(feasible.sum()), right)
    ax.plot(marks, polished[feasible], linestyle="none", marker="D", markersize=5, color=INK, alpha=0.6, zorder=4)
    ax.axhline(float(final), color=INK, linewidth=1.0, linestyle=(0, (5, 3)), zorder=2)
    ax.set_xlim(0, right + 0.02 * max(last, 1))
    if metric is not None:
        ax.set_yscale("log")
        ax.set_ylim(*_limits(heights, polished[feasible], float(final)))
        tick_in_plain_numbers(ax.yaxis)
    ax.set_xlabel("step of the interior-point method (in the first steps lenses may overlap)")
    read = "score" if metric is None else metric.name
    ax.set_ylabel(read + ("" if metric is None else f" ({metric.unit})"))
    draw_grid(ax)
    unit = "" if metric is None else f" {metric.unit}"
    _draw_legend(ax, convergence, int(feasible.sum()), f"{significant(float(final), 4)}{unit}")


def _lowest(heights: np.ndarray) -> int | None:
    """Give the start that ends lowest, of the healthy ones."""
    return int(np.nanargmin(heights[:, -1])) if np.isfinite(heights[:, -1]).any() else None


def _limits(heights: np.ndarray, polished: np.ndarray, final: float) -> tuple[float, float]:
    every = np.concatenate([heights[np.isfinite(heights) & (heights > 0)], polished, [final]])
    every = every[every > 0]
    if not len(every):
        return 0.1, 10.0
    return every.min() / 1.15, every.max() * 1.15


def _draw_legend(ax: Axes, convergence: Convergence, feasible: int, final: str) -> None:
    failed = len(convergence.polished_scores) - feasible
    marks = f"{feasible} polished, feasible" + (f" ({failed} did not become so)" if failed else "")
    handles = [
        Line2D([], [], color=START, linewidth=1.0, label=f"{len(convergence.scores)} starts"),
        Line2D([], [], color=BEST, linewidth=2.4, label="the best start that was polished"),
        Line2D([], [], color=INK, marker="D", markersize=5, linestyle="none", alpha=0.6, label=marks),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (5, 3)), label=f"design: {final}"),
    ]
    place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 2, "borderaxespad": 0.3}
    ax.legend(handles=handles, frameon=False, fontsize=SMALL_FONT_SIZE, columnspacing=1.4, handlelength=2.0, **place)
    ax.tick_params(colors=FAINT, labelcolor=INK)
