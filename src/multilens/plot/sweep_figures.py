"""The figures of a sweep, of which each makes sense for some sweeps only."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from multilens.layout import Layout
from multilens.plot.style import style
from multilens.plot.sweep_count import count_figure
from multilens.plot.sweep_front import front_figure
from multilens.plot.sweep_layouts import layouts_figure
from multilens.plot.sweep_map import map_figure
from multilens.question import Question
from multilens.sweep_row import SweepRow

NAMES = ("count", "layouts", "front", "map")


def sweep_figure(name: str, rows: Sequence[SweepRow], answers: Mapping[int, tuple[Question, Layout]]) -> Figure | None:
    """Draw one picture of a sweep; None where it makes no sense for it.

    Args:
        name: one of `NAMES`.
        rows: of the table of the sweep.
        answers: of "layouts", as `sweep_figures` has them; the others look at the rows alone.

    Raises:
        ValueError: there is no picture of that name.
    """
    with style():
        match name:
            case "count":
                return count_figure(rows)
            case "layouts":
                return layouts_figure(rows, answers)
            case "front":
                return front_figure(rows)
            case "map":
                return map_figure(rows)
    raise ValueError(f"{name} must be one of {', '.join(NAMES)}")


def sweep_figures(rows: Sequence[SweepRow], answers: Mapping[int, tuple[Question, Layout]]) -> dict[str, Figure]:
    """Draw every picture that makes sense for a sweep.

    Args:
        rows: of its table.
        answers: what was asked and the layout that was found, by job, of the rows that `sweep_layouts.shown` gives.

    Returns:
        "count" where the number of lenses varies, "layouts" where any was found, "front" where what an error costs varies, and
        "map" where two keys vary of the device or the search.
    """
    figures = {name: sweep_figure(name, rows, answers) for name in NAMES}
    return {name: figure for name, figure in figures.items() if figure is not None}
