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


def sweep_figures(rows: Sequence[SweepRow], answers: Mapping[int, tuple[Question, Layout]]) -> dict[str, Figure]:
    """Draw every picture that makes sense for a sweep.

    Args:
        rows: of its table.
        answers: what was asked and the layout that was found, by job, of the rows that `sweep_layouts.shown` gives.

    Returns:
        "count" where the number of lenses varies, "layouts" where any was found, "front" where what an error costs varies, and
        "map" where two keys vary of the device or the search.
    """
    with style():
        figures = (count_figure(rows), layouts_figure(rows, answers), front_figure(rows), map_figure(rows))
    return {name: figure for name, figure in zip(NAMES, figures, strict=True) if figure is not None}
