"""A chart whose points are links: each leads to what it stands for, elsewhere on the page."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from multilens.plot.axis import draw_grid, tick_in_plain_numbers
from multilens.plot.style import SMALL_FONT_SIZE, style
from multilens.plot.svg import inline_svg, page_figure

WIDE, HIGH = 400.0, 270.0
"""Points across a chart, and high without its legend."""

LEFT, RIGHT, FOOT, LINE = 56.0, 14.0, 42.0, 15.0
"""Points beside and below the axes, and for each line of the legend."""

LOGARITHMIC_SPAN = 4.0
"""Numbers that span more than this factor are drawn on a logarithmic axis."""

ALIKE = 1e-2
"""Numbers that differ by a smaller part have few ticks, with room for their digits."""

MARGIN = 0.07
"""Part of the span that is left free on either side."""

LEGEND_WIDTH = 56
"""Letters of a line of the legend."""


@dataclass(frozen=True)
class Series:
    """Points that belong together.

    Args:
        words: for the legend.
        colour: of the points.
        points: x, y and where each leads, such as #job-3.
        joined: "default" by straight lines, "steps-post" by steps, None not at all.
    """

    words: str
    colour: str
    points: tuple[tuple[float, float, str], ...]
    joined: str | None


def linked_svg(
    series: Sequence[Series], axes: tuple[str, str], name: str, label: str, links: Mapping[str, str], whole: bool
) -> str:
    """Draw a chart as SVG text.

    Args:
        series: with at least one point among them.
        axes: what runs to the right and what upwards, with their units.
        name: of the chart on its page.
        label: what it shows, for those who cannot see it.
        links: words for whoever points at a link, by where it leads.
        whole: whether only whole numbers run to the right.
    """
    columns = max(1, min(3, LEGEND_WIDTH // (max(len(each.words) for each in series) + 5)))
    head = LINE * -(-len(series) // columns) + 8
    with style():
        figure = page_figure(WIDE, HIGH + head)
        sides = (LEFT / WIDE, FOOT / (HIGH + head), (WIDE - LEFT - RIGHT) / WIDE, (HIGH - FOOT) / (HIGH + head))
        ax = figure.add_axes(sides)
        ax.set(xlabel=axes[0], ylabel=axes[1])
        _set_limits(ax, series, whole)
        for each in series:
            x, y, urls = zip(*each.points, strict=True)
            if each.joined is not None:
                ax.plot(x, y, color=each.colour, linewidth=1.4, drawstyle=each.joined, zorder=2)
            ax.scatter(
                x, y, s=34, color=each.colour, edgecolors="white", linewidths=0.8, zorder=3, urls=urls, label=each.words
            )
        place = {"loc": "lower left", "bbox_to_anchor": (-0.08, 1.0), "ncols": columns, "borderaxespad": 0.2}
        ax.legend(
            frameon=False, fontsize=SMALL_FONT_SIZE, columnspacing=1.2, handletextpad=0.2, labelspacing=0.3, **place
        )
        draw_grid(ax)
        # Numbers at the shorter minor ticks stand in line with the others.
        ax.tick_params(which="minor", pad=5)
        return inline_svg(figure, name, label, links=links, role="group")


def _set_limits(ax: Axes, series: Sequence[Series], whole: bool) -> None:
    points = [point for each in series for point in each.points]
    for axis, limit, numbers in (
        (ax.xaxis, ax.set_xlim, [x for x, _, _ in points]),
        (ax.yaxis, ax.set_ylim, [y for _, y, _ in points]),
    ):
        low, high = min(numbers), max(numbers)
        if axis is ax.xaxis and whole:
            limit(low - 0.5, high + 0.5)
            axis.set_major_locator(MaxNLocator(integer=True))
        elif high > LOGARITHMIC_SPAN * low > 0:
            (ax.set_xscale if axis is ax.xaxis else ax.set_yscale)("log")
            limit(low / (high / low) ** MARGIN, high * (high / low) ** MARGIN)
            tick_in_plain_numbers(axis)
        else:
            room = MARGIN * (high - low) or abs(high) or 1.0
            limit(low - room, high + room)
            # Numbers that differ late are long.
            alike = high - low < ALIKE * abs(high)
            axis.set_major_locator(MaxNLocator(nbins=2 if alike else 6))
