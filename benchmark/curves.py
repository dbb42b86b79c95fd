"""How good each method is after how long: a panel for each problem."""

from math import ceil, inf

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from benchmark.measures import GRACE, Run, median_of
from benchmark.methods import OURS, PEERS
from benchmark.problems import Case
from benchmark.report import Results
from multilens.plot.style import FAINT, INK, LENS_COLOURS, SMALL_FONT_SIZE

LEAST, MOST = 1e-5, 1.0
"""Excess over the best known score at the foot and the head of a panel; what is less is drawn at the foot."""

FIRST = 0.03
"""s; where the axis of time begins."""

COLUMNS = 4

DASHES = ((None, None), (None, None), (6.0, 2.0), (1.5, 1.5), (6.0, 1.5, 1.5, 1.5), (3.0, 1.0))

COLOURS = dict(zip((OURS, *PEERS), (LENS_COLOURS[i] for i in (0, 5, 1, 2, 3, 8)), strict=True))


def curves(results: Results) -> Figure:
    """Draw the median over the seeds of the excess over the best known score against time, both logarithmic."""
    columns = min(COLUMNS, len(results.cases))
    rows = ceil(len(results.cases) / columns)
    size = (3.1 * columns + 0.4, 2.35 * rows + 0.9)
    figure, panels = plt.subplots(
        rows, columns, figsize=size, layout="constrained", squeeze=False, sharex=True, sharey=True
    )
    for ax, case in zip(panels.flat, results.cases, strict=False):
        _draw(ax, results, case)
    for ax in panels.flat[len(results.cases) :]:
        ax.set_axis_off()
        # The panel above the empty place has the axis of time that would have been there.
    for column in range(columns):
        lowest = max(row for row in range(rows) if row * columns + column < len(results.cases))
        panels[lowest, column].tick_params(labelbottom=True)
    methods = [method for method in (OURS, *PEERS) if any(run.method == method for run in results.runs)]
    figure.legend(
        handles=[Line2D([], [], label=method, **_look(method)) for method in methods],
        loc="outside upper center",
        ncols=len(methods),
        frameon=False,
        fontsize=SMALL_FONT_SIZE,
        handlelength=2.6,
    )
    figure.supxlabel("time (s)", fontsize=SMALL_FONT_SIZE)
    figure.supylabel("score above the best known (%)", fontsize=SMALL_FONT_SIZE)
    return figure


def _draw(ax: Axes, results: Results, case: Case) -> None:
    best = results.best[case.name].score
    # Ours last, on top of the others.
    for method in reversed((OURS, *PEERS)):
        times, scores = median_curve(results.of(case.name, method), results.limit)
        if len(times):
            ax.step(times, np.clip(scores / best - 1, LEAST, None), where="post", **_look(method))
    ax.set(xscale="log", yscale="log", xlim=(FIRST, 1.2 * results.limit), ylim=(LEAST, MOST))
    ax.set_title(case.name, fontsize=SMALL_FONT_SIZE, loc="left")
    ax.axhline(1e-3, color=FAINT, linewidth=0.7, linestyle=(0, (2, 3)), zorder=0)
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    ax.xaxis.set_major_formatter(plain)
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))
    ax.set_yticks([1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0])
    ax.minorticks_off()
    ax.tick_params(labelsize=SMALL_FONT_SIZE, colors=FAINT, labelcolor=INK)
    ax.grid(True, which="major", color="#ececec", linewidth=0.8)
    ax.set_axisbelow(True)


def median_curve(runs: list[Run], limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Give the times at which the median over the runs changes, s, and what it is from then on, mm^2; while finite."""
    times = sorted({each.seconds for run in runs for each in run.found if each.seconds <= limit + GRACE})
    scores = [
        median_of([min((each.score for each in run.found if each.seconds <= time), default=inf) for run in runs])
        for time in times
    ]
    finite = [(time, score) for time, score in zip(times, scores, strict=True) if score < inf]
    if not finite:
        return np.empty(0), np.empty(0)
    finite.append((limit + GRACE, finite[-1][1]))
    at, score = np.array(finite).T
    return at, score


def _look(method: str) -> dict:
    rank = [OURS, *PEERS].index(method)
    look = {"color": COLOURS[method], "linewidth": 2.4 if rank == 0 else 1.8 if rank == 1 else 1.2, "zorder": 10 - rank}
    return look if DASHES[rank][0] is None else look | {"dashes": DASHES[rank]}
