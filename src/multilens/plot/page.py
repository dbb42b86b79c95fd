"""Pictures of a design for a page: SVG whose parts have names, so that a script can light them up."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from matplotlib.axes import Axes

from multilens.layout import Layout
from multilens.metrics import as_quoted
from multilens.plot.back import MARGIN, SCALE_BAR_HEIGHT, draw_back
from multilens.plot.bare import best_pairs, extent, part_name
from multilens.plot.errors import curve_name, draw_errors, draw_winners
from multilens.plot.style import INK, WARNING, style
from multilens.plot.svg import inline_svg, page_figure
from multilens.plot.tolerance import draw_tolerance
from multilens.plot.units import significant
from multilens.problem import Problem
from multilens.question import Question
from multilens.tolerance import Tolerance

WIDE = 400.0
"""Points across a picture: words stay readable on a phone, whose screen is about as wide."""

LEFT, LEGEND, FOOT, STRIP = 66.0, 38.0, 40.0, 148.0
"""Points beside the curves for their scale, above them for the legend, below them for depths and for who is best."""

LINE, DOT = "depth-line", "depth-dot"
"""Ids of what marks a depth on the curves; it is drawn at their lower left corner, to be moved from there."""


@dataclass(frozen=True)
class ErrorPicture:
    """The errors of a design as SVG text, and where a mark of a depth is to be moved.

    Args:
        svg: the text.
        marks: points to the right and down from the lower left corner of the curves, for each of the depths given.
        left: where that corner is, points from the left of the picture.
        across: width of the curves, points.
    """

    svg: str
    marks: tuple[tuple[float, float], ...]
    left: float
    across: float


def layout_svg(
    problem: Question, layout: Layout, name: str, label: str, width: float = WIDE, most: float = 560.0
) -> str:
    """Draw a back and its lenses to scale.

    Args:
        problem: what is asked, of a device as it is drawn.
        layout: one layout, not a batch.
        name: of the picture on the page.
        label: what it shows, for those who cannot see it.
        width: points.
        most: height that it may have, points.
    """
    left, top, right, bottom = extent(problem, layout)
    fitting = (width - 2 * MARGIN) * (bottom - top) / (right - left) + 2 * MARGIN + SCALE_BAR_HEIGHT
    height = min(max(fitting, 120.0), most)
    with style():
        figure = page_figure(width, height)
        draw_back(_axes(figure, 0, 0, width, height), problem, layout)
        return inline_svg(figure, name, label, _titles(problem, layout))


def errors_svg(
    problem: Problem,
    layout: Layout,
    name: str,
    label: str,
    tolerance: Tolerance | None,
    depths: Sequence[float],
    errors: Sequence[float],
) -> ErrorPicture:
    """Draw the errors of a design against depth, and who is best where, with marks that are to be moved to a depth.

    Args:
        problem: what is asked, of a device as it is drawn.
        layout: one layout, not a batch.
        name: of the picture on the page.
        label: what it shows, for those who cannot see it.
        tolerance: that is marked, or None for none.
        depths: mm, to which the marks are to go.
        errors: at each of them, mm; infinite where nothing measures.
    """
    height = 330.0 + STRIP
    head = LEGEND + 18 * (tolerance is not None)
    with style():
        figure = page_figure(WIDE, height)
        curves = (WIDE - LEFT - 12, height - STRIP - FOOT - head)
        draw_winners(_axes(figure, LEFT, 0, curves[0], STRIP), problem, layout)
        axes = _axes(figure, LEFT, STRIP + FOOT, *curves)
        draw_errors(axes, problem, layout)
        if tolerance is not None:
            draw_tolerance(axes, problem, layout, tolerance, above=LEGEND)
        quoted = as_quoted(
            problem.metric, *(torch.tensor(numbers, dtype=torch.float64) for numbers in (errors, depths))
        )
        marks = _draw_marks(axes, depths, quoted.tolist())
        titles = {curve_name(k): measurement.label for k, measurement in enumerate(problem.measurements)}
        return ErrorPicture(inline_svg(figure, name, label, titles), marks, LEFT, curves[0])


def _axes(figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Add axes at points from the lower left corner."""
    across, up = figure.bbox.size
    return figure.add_axes((left / across, bottom / up, width / across, height / up))


def _draw_marks(axes: Axes, depths: Sequence[float], errors: Sequence[float]) -> tuple[tuple[float, float], ...]:
    near, bottom, top = axes.get_xlim()[0], *axes.get_ylim()
    look = {"color": WARNING, "clip_on": False, "zorder": 8}
    axes.plot([near, near], [bottom, top], linewidth=1.2, gid=LINE, **look)
    axes.plot([near], [bottom], "o", markersize=7, markeredgecolor=INK, gid=DOT, **look)
    corner = axes.transData.transform((near, bottom))
    places = [
        axes.transData.transform((depth, min(max(error, bottom), top))) - corner
        for depth, error in zip(depths, errors, strict=True)
    ]
    return tuple((round(x.item(), 2), round(-y.item(), 2)) for x, y in places)


def _titles(problem: Question, layout: Layout) -> dict[str, str]:
    titles = {f"lens-{i + 1}": f"lens {i + 1}" for i in range(layout.count)}
    for pair in best_pairs(problem, layout):
        first, second = pair.lenses
        length = (layout.position[first] - layout.position[second]).norm().item()
        titles[part_name(pair)] = f"{pair.label}, {significant(length, 4)} mm"
    return titles
