"""The run folder: everything about one design in one place, written whole or not at all, and drawn again from itself.

config.yaml      what was asked, as it was resolved
design.json      the design, which alone is enough for everything else
layout.csv       a row for each lens
sensitivity.csv  what it costs that one of them is off, where depths were asked for
*.svg, *.png     its pictures
run.log          what the run said
"""

import os
from pathlib import Path

from multilens.cad.plan import plan_of
from multilens.cad.write_csv import write_csv
from multilens.design import Design
from multilens.storage import folder_written_whole, scratch_folder
from multilens.table_text import csv_text

CONFIG, DESIGN, LAYOUT, LOG = "config.yaml", "design.json", "layout.csv", "run.log"
SENSITIVITY = "sensitivity.csv"


def write_run(folder: Path, design: Design, config_text: str, log_text: str) -> None:
    """Write the folder of a run that found a design.

    Args:
        folder: where it goes; may be there already if it is empty. Its parent must exist.
        design: feasible.
        config_text: what was asked, as it was resolved.
        log_text: what the run said.

    Raises:
        ValueError: the design is infeasible.
        TypeError: its problem has a score or a cue of one's own.
        FileExistsError: something is in the folder already.
        OSError: it cannot be written, or the disk is full; nothing is left behind then.
    """
    with folder_written_whole(folder) as inside:
        write_design(inside, design)
        write_words(inside, config_text, log_text)
        _draw(design, inside)


def write_design(folder: Path, design: Design) -> None:
    """Write the files that a design alone decides, save for the pictures, into a folder; raises what `write_run` raises."""
    _write(folder / DESIGN, design.to_json())
    _write(folder / LAYOUT, write_csv(plan_of(design)))
    _write(folder / SENSITIVITY, csv_text(design.sensitivity().cells()))


def write_words(folder: Path, config_text: str, log_text: str) -> None:
    """Write what was asked and what was said into a folder; an OSError if that fails."""
    _write(folder / CONFIG, config_text)
    _write(folder / LOG, log_text)


def redraw(folder: Path) -> None:
    """Draw the pictures of a run again from its saved design alone; nothing else is touched.

    Args:
        folder: of a run.

    Raises:
        ValueError: design.json is damaged; the file is named.
        OSError: there is no design.json, or the pictures cannot be written; those that were there stay then.
    """
    folder = folder.resolve()
    design = Design.load(folder / DESIGN)
    with scratch_folder(folder) as drawn:
        _draw(design, drawn)
        for picture in sorted(drawn.iterdir()):
            os.replace(picture, folder / picture.name)


def _write(path: Path, text: str) -> None:
    path.write_bytes(text.encode())


def _draw(design: Design, folder: Path) -> None:
    # Loaded only where something is drawn: it costs a second.
    from multilens.plot.figures import design_figures, overview_figure, save_figures

    figures = design_figures(design.problem, design.layout, design.convergence, design.tolerance)
    overview = overview_figure(design.problem, design.layout, design.tolerance)
    save_figures(figures | {"overview": overview}, folder)
