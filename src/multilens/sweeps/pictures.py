"""The pictures of a sweep in its folder, drawn from its table and its jobs' designs alone.

count.svg, count.png     error against the number of lenses, the bound below it, and what each further lens gains
layouts.svg, .png        the layouts side by side, to one scale
front.svg, .png          error against what it costs: area of the back, of the apertures, number of lenses
map.svg, .png            error over two swept keys
"""

import os
from itertools import starmap
from pathlib import Path

from multilens.design import Design
from multilens.layout import Layout
from multilens.question import Question
from multilens.runs import DESIGN
from multilens.storage import scratch_folder
from multilens.sweep_row import SweepRow
from multilens.sweeps.compute import Compute
from multilens.sweeps.locks import PICTURES, held
from multilens.sweeps.table import read_rows


def draw_pictures(folder: Path, compute: Compute = starmap) -> tuple[Path, ...]:
    """Draw the pictures that make sense for a sweep and put them into its folder; nothing else is touched.

    Those of an earlier drawing that make no sense any more are taken away. A job whose design cannot be read is drawn as one
    that has none.

    Args:
        folder: of the sweep.
        compute: draws each picture, here or elsewhere.

    Returns:
        The pictures.

    Raises:
        OSError: the folder cannot be read or written; the pictures that were there stay then.
    """
    # Loaded only where something is drawn: it costs a second.
    from multilens.plot.sweep_figures import NAMES

    folder = folder.resolve()
    rows = read_rows(folder)
    # In the sweep's own folder and under a lock, what a kill leaves is cleared away when the sweep is run again.
    with held(folder, PICTURES), scratch_folder(folder / PICTURES) as drawn:
        tasks = [(name, folder, rows, drawn) for name in NAMES]
        names = [path.name for paths in compute(_drawn, tasks) for path in paths]
        for name in names:
            os.replace(drawn / name, folder / name)
    for name in (f"{stem}.{kind}" for stem in NAMES for kind in ("svg", "png")):
        if name not in names:
            (folder / name).unlink(missing_ok=True)
    return tuple(folder / name for name in names)


def _drawn(name: str, folder: Path, rows: tuple[SweepRow, ...], into: Path) -> tuple[Path, ...]:
    """Draw one picture of a sweep into a folder and give its files; none where it makes no sense."""
    from multilens.plot.figures import save_figures
    from multilens.plot.sweep_figures import sweep_figure
    from multilens.plot.sweep_layouts import shown

    answers = _answers(folder, shown(rows)) if name == "layouts" else {}
    figure = sweep_figure(name, rows, answers)
    return () if figure is None else save_figures({name: figure}, into)


def _answers(folder: Path, rows: tuple[SweepRow, ...]) -> dict[int, tuple[Question, Layout]]:
    """Give what was asked and the layout that was found, by job, as far as it can be read."""
    found = {}
    for row in rows:
        if row.figure is None:
            continue
        try:
            design = Design.load(folder / str(row.job) / DESIGN)
        except (ValueError, OSError):
            continue
        found[row.job] = design.problem, design.layout
    return found
