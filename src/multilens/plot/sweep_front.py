"""What the least error costs: error against the area of the back, of the apertures and the number of lenses."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from multilens.plot.axis import draw_grid, tick_in_plain_numbers
from multilens.plot.labels import Labels
from multilens.plot.sheet import ABOVE_AXES, sheet, width_for
from multilens.plot.style import FAINT, INK, LENS_COLOURS, RULE, SMALL_FONT_SIZE
from multilens.plot.sweep_groups import (
    figure_of,
    in_words,
    is_asked,
    left_out,
    questions,
    short_names,
    shortened,
    varied,
    without_design,
)
from multilens.sweep_row import SweepRow

FRONT, DOMINATED = LENS_COLOURS[0], RULE

DIGITS = 6
"""That count: what differs less is alike, so that rounding makes no front."""

LONGEST = 14
"""Letters of each value in a label."""

LOGARITHMIC_SPAN = 4.0
"""Costs that span more than this factor are drawn on a logarithmic axis."""

MOST_ROWS, BELOW = 4, 0.7
"""Rows of panels in a figure, and inches below each."""


@dataclass(frozen=True)
class Cost:
    """What there is to pay for a small error.

    Args:
        field: of a row.
        words: for the axis.
    """

    field: str
    words: str

    def of(self, row: SweepRow) -> float:
        """Give what a row that has a design costs."""
        return _rounded(getattr(row, self.field))


COSTS = (
    Cost("back_area", "area of the back (mm²)"),
    Cost("aperture_area", "area of all apertures (mm²)"),
    Cost("lens_count", "lenses"),
)


def front_figure(rows: Sequence[SweepRow]) -> Figure | None:
    """Draw error against each cost that varies, a row for everything that was asked; None where no cost varies.

    Args:
        rows: of the table of a sweep.
    """
    every = [(question, costs_that_vary(question.found)) for question in questions(rows)]
    several = [(question, costs) for question, costs in every if costs]
    if not several:
        return None
    panels, keys = several[:MOST_ROWS], varied(rows)
    names, own = short_names(keys), [key for key in keys if not is_asked(key)]
    told = ", ".join(names[key] for key in own)
    notes = [
        f"labelled: what no other job beats in both error and cost; a label tells {told} (+ how many more are alike)",
        without_design(rows),
        left_out(len(several) - len(panels), "questions"),
    ]
    columns = max(len(costs) for _, costs in panels)
    high = 4.3 if len(panels) == 1 else 3.6
    page = sheet(width_for(columns), len(panels) * (ABOVE_AXES + high + BELOW), "What a small error costs", notes)
    unlabelled = 0
    for band, (question, costs) in enumerate(panels):
        for column, cost in enumerate(costs):
            ax = page.panel(band, column, columns, high, BELOW, in_words(question.settings, names))
            unlabelled += draw_front(ax, question.quantity, question.found, cost, own)
    page.say_below(left_out(unlabelled, "labels, for want of room"))
    return page.figure


def costs_that_vary(rows: Sequence[SweepRow]) -> tuple[Cost, ...]:
    """Give the costs of which rows that have designs come with more than one."""
    return tuple(cost for cost in COSTS if len({cost.of(row) for row in rows}) > 1)


def front(costs: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Give which points no other beats, by cost ascending: none is at most as dear and at most as bad, and one of both less.

    Points that are alike in both beat each other not; all of them are given.
    """
    order = sorted(range(len(costs)), key=lambda k: (costs[k], errors[k], k))
    kept: list[int] = []
    for k in order:
        if not kept or errors[k] < errors[kept[-1]] or (costs[k], errors[k]) == (costs[kept[-1]], errors[kept[-1]]):
            kept.append(k)
    return kept


def cheapest(rows: Sequence[SweepRow], cost: Cost) -> list[SweepRow]:
    """Give the rows that no other beats in cost and error."""
    return [rows[k] for k in front(*_columns(rows, cost))]


def draw_front(ax: Axes, quantity: str, rows: Sequence[SweepRow], cost: Cost, keys: Sequence[str]) -> int:
    """Draw error against cost: what no other job beats in both strong, joined and labelled, the others faint.

    Args:
        ax: drawn on; the error logarithmic where all are above 0. Labels are placed for the size that it has now.
        quantity: what the error is, with its unit.
        rows: that have designs and errors in the same unit; at least one.
        cost: along x.
        keys: whose values a label tells, in their order.

    Returns:
        How many labels found no room.
    """
    best = cheapest(rows, cost)
    ax.set_xlabel(cost.words)
    ax.set_ylabel(quantity)
    _set_limits(ax, rows, cost)
    beaten = {row.job for row in rows} - {row.job for row in best}
    others = [row for row in rows if row.job in beaten]
    ax.plot(*_columns(others, cost), linestyle="none", marker="o", markersize=4, color=DOMINATED, zorder=2)
    look = {"color": FRONT, "linewidth": 1.2, "drawstyle": "steps-post", "marker": "o", "markersize": 6}
    ax.plot(*_columns(best, cost), zorder=3, **look)
    labels, at = Labels(ax), _columns(best, cost)
    for point in zip(*at, strict=True):
        labels.keep_off(*point, 4.0)
    corners = [(x, y) for (x0, y), (x1, _) in pairwise(zip(*at, strict=True)) for x in (x0, x1)]
    labels.rather_not_on([*corners, (at[0][-1], at[1][-1])])
    labels.rather_not_on_points(list(zip(*_columns(others, cost), strict=True)))
    alike: dict[tuple[float, float], list[SweepRow]] = {}
    for row, point in zip(best, zip(*at, strict=True), strict=True):
        alike.setdefault(point, []).append(row)
    written = [labels.write(*point, label(same, keys), fontsize=SMALL_FONT_SIZE - 1.5) for point, same in alike.items()]
    return written.count(False)


def label(rows: Sequence[SweepRow], keys: Sequence[str]) -> str:
    """Name rows that share a point: the values of the first, and how many more there are."""
    settings = dict(rows[0].settings)
    values = " · ".join(shortened(settings[key], LONGEST) for key in keys if key in settings)
    return values + (f" (+{len(rows) - 1})" if len(rows) > 1 else "")


def _set_limits(ax: Axes, rows: Sequence[SweepRow], cost: Cost) -> None:
    prices, errors = _columns(rows, cost)
    low, high = min(prices), max(prices)
    if cost.field == "lens_count":
        ax.set_xlim(low - 0.6, high + 0.6)
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    elif high > LOGARITHMIC_SPAN * low > 0:
        ax.set_xscale("log")
        ax.set_xlim(low / (high / low) ** 0.08, high * (high / low) ** 0.12)
        tick_in_plain_numbers(ax.xaxis)
    else:
        ax.set_xlim(low - 0.08 * (high - low), high + 0.12 * (high - low))
    if min(errors) > 0:
        span = max(max(errors) / min(errors), 1.05)
        ax.set_yscale("log")
        ax.set_ylim(min(errors) / span**0.1, max(errors) * span**0.1)
        tick_in_plain_numbers(ax.yaxis)
    else:
        ax.set_ylim(0, 1.1 * max(errors) or 1.0)
    draw_grid(ax)
    ax.tick_params(colors=FAINT, labelcolor=INK)


def _columns(rows: Sequence[SweepRow], cost: Cost) -> tuple[list[float], list[float]]:
    return [cost.of(row) for row in rows], [_rounded(figure_of(row)) for row in rows]


def _rounded(number: float) -> float:
    return float(f"{number:.{DIGITS}g}")
