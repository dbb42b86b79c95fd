"""Whole figures, ready for a talk, and their files."""

from collections.abc import Mapping
from pathlib import Path

from matplotlib.figure import Figure

from multilens.certificate import certify
from multilens.convergence import Convergence
from multilens.layout import Layout
from multilens.plot.back import draw_layout
from multilens.plot.convergence import draw_convergence
from multilens.plot.errors import draw_errors, draw_winners
from multilens.plot.style import FONT_SIZE, TITLE_FONT_SIZE, WARNING, style
from multilens.plot.tolerance import draw_tolerance
from multilens.plot.units import depth_unit, significant
from multilens.problem import Problem
from multilens.question import Question
from multilens.robust import Robust, as_drawn
from multilens.tolerance import Tolerance

DOTS_PER_INCH = 200
"""Of the PNG files."""

WIDE, SHEET = (13.333, 7.5), (9.0, 7.0)
"""Width and height of a slide of 16:9 and of a single picture, inches."""

HEAD = 0.9
"""Inches at the top of a figure that its title takes."""


def design_figures(
    problem: Question, layout: Layout, convergence: Convergence | None = None, tolerance: Tolerance | None = None
) -> dict[str, Figure]:
    """Draw each picture of a design by itself.

    Args:
        problem: what is asked.
        layout: one layout, not a batch.
        convergence: of the starts, or None where nothing was searched.
        tolerance: that is marked on the errors, or None for none.

    Returns:
        "layout" always, "errors" for a problem with depths, "convergence" where there is one.
    """
    asked, problem = problem, as_drawn(problem)
    with style():
        figures = {"layout": _figure(asked, layout, SHEET)}
        draw_layout(_axes(figures["layout"], 0.15, 0.15, 8.7, 5.85), problem, layout)
        if isinstance(problem, Problem):
            figures["errors"] = _figure(asked, layout, SHEET)
            _draw_errors_and_winners(figures["errors"], problem, layout, tolerance, 0.95, 7.75)
        if convergence is not None:
            figures["convergence"] = _figure(asked, layout, SHEET)
            score = asked.score(layout).item()
            draw_convergence(_axes(figures["convergence"], 0.95, 0.75, 7.75, 4.85), convergence, score, asked.metric)
    return figures


def overview_figure(problem: Question, layout: Layout, tolerance: Tolerance | None = None) -> Figure:
    """Draw a design on one slide: the back with its lenses, the errors, and who wins at which depth.

    Args:
        problem: what is asked; one without depths has the back alone.
        layout: one layout, not a batch.
        tolerance: that is marked on the errors, or None for none.
    """
    asked, problem = problem, as_drawn(problem)
    with style():
        figure = _figure(asked, layout, WIDE)
        if isinstance(problem, Problem):
            draw_layout(_axes(figure, 0.15, 0.15, 6.35, 6.4), problem, layout)
            _draw_errors_and_winners(figure, problem, layout, tolerance, 7.35, 5.65)
        else:
            draw_layout(_axes(figure, 0.15, 0.15, 13.0, 6.4), problem, layout)
    return figure


def save_figures(figures: Mapping[str, Figure], folder: Path | str) -> tuple[Path, ...]:
    """Write each figure as NAME.svg and NAME.png; the same figure gives the same bytes.

    Args:
        figures: by name.
        folder: there already.

    Returns:
        The files, in the order of the figures.

    Raises:
        OSError: the folder is missing, cannot be written or is full.
    """
    paths = []
    with style():
        for name, figure in figures.items():
            vector, raster = Path(folder) / f"{name}.svg", Path(folder) / f"{name}.png"
            figure.savefig(vector, metadata={"Date": None})
            figure.savefig(raster, dpi=DOTS_PER_INCH, metadata={"Software": None})
            paths += [vector, raster]
    return tuple(paths)


def title(problem: Question, layout: Layout) -> str:
    """Say in one line how many lenses there are and how well they do over which depths, of many devices the one as drawn."""
    lenses = ("1 lens" if layout.count == 1 else f"{layout.count} lenses") + " as drawn" * isinstance(problem, Robust)
    problem = as_drawn(problem)
    score, metric = problem.score(layout).item(), problem.metric
    if not isinstance(problem, Problem) or metric is None:
        return f"{lenses}, score {significant(score, 6)}"
    near, far = problem.depths.min().item(), problem.depths.max().item()
    over = depth_unit(problem).range(near, far) if far > near else depth_unit(problem).text(far)
    over = f"{'over' if far > near else 'at'} {over}{'' if problem.field is None else ' and the field'}"
    return f"{lenses}, {metric.name} {significant(metric.figure(score))} {metric.unit} {over}"


def warning(problem: Question, layout: Layout) -> str:
    """Say which constraint a layout breaks most, or nothing where it keeps them all."""
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    if certificate.feasible:
        return ""
    tightest = certificate.tightest
    return f"not feasible: {tightest.what} lacks {significant(-tightest.room)} mm"


def _figure(problem: Question, layout: Layout, size: tuple[float, float]) -> Figure:
    figure = Figure(figsize=size)
    look = {"ha": "left", "parse_math": False}
    figure.text(0.35 / size[0], 1 - 0.5 / size[1], title(problem, layout), fontsize=TITLE_FONT_SIZE, **look)
    wrong = warning(problem, layout)
    if wrong:
        figure.text(0.35 / size[0], 1 - 0.78 / size[1], wrong, fontsize=FONT_SIZE, color=WARNING, **look)
    return figure


def _axes(figure: Figure, left: float, bottom: float, width: float, height: float):
    """Add axes at inches from the lower left corner."""
    across, up = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / up, width / across, height / up))


def _draw_errors_and_winners(
    figure: Figure, problem: Problem, layout: Layout, tolerance: Tolerance | None, left: float, width: float
) -> None:
    """Draw errors above winners, their depths aligned, from the bottom of a figure to its title."""
    winners = 1.7
    height = figure.get_size_inches()[1] - HEAD - 0.35 - winners - 0.75
    draw_winners(_axes(figure, left, 0.1, width, winners), problem, layout)
    errors = _axes(figure, left, 0.1 + winners + 0.6, width, height)
    draw_errors(errors, problem, layout)
    if tolerance is not None:
        draw_tolerance(errors, problem, layout, tolerance)
