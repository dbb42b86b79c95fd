"""The error over two swept keys, a cell for each pair of values."""

from collections.abc import Sequence
from math import ceil, prod

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, Normalize, to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from multilens.plot.axis import tick_in_plain_numbers
from multilens.plot.canvas import POINTS_PER_INCH, paper_size, text_size
from multilens.plot.sheet import ABOVE_AXES, LEFT_OF_AXES, RIGHT_OF_AXES, sheet, width_for
from multilens.plot.style import FAINT, INK, PAPER, SMALL_FONT_SIZE, WARNING, ink_on
from multilens.plot.sweep_groups import (
    Group,
    figure_of,
    grouped,
    in_words,
    is_asked,
    left_out,
    quantity_of,
    short_names,
    shortened,
    varied,
    without_design,
)
from multilens.plot.units import significant
from multilens.sweep_row import SweepRow

COLOURS = colormaps["cividis_r"]
"""Alike to readers of every colour vision, and dark where the error is large."""

LONGEST_TICK, LETTER = 16, 6.2
"""Letters of a value along an axis, and points that one takes, a little more than on average."""

BAR = 0.8
"""Inches at the right of every map that the bar of colours and its numbers take."""

SMALLEST_PRINT = 6.0
"""Points; in cells too small for that no number is written."""


SPARSEST = 0.1
"""Part of all combinations of the values that must have been tried: of numbers that were chosen freely a map shows nothing."""

MOST_ROWS, MOST_COLUMNS = 4, 3
"""Of maps in a figure."""


def map_figure(rows: Sequence[SweepRow]) -> Figure | None:
    """Draw the error over two swept keys, a map for every setting of the others; None where `axes_of_the_map` finds no two.

    Maps of one row have the same colours.

    Args:
        rows: of the table of a sweep.
    """
    keys = varied(rows)
    pair = axes_of_the_map(rows)
    bands = [] if pair is None else _bands(rows, [key for key in keys if key not in pair])
    if pair is None or not bands:
        return None
    kept = [band[:MOST_COLUMNS] for band in bands[:MOST_ROWS]]
    names, columns = short_names(keys), max(map(len, kept))
    across, up = ((names[key], keys[key]) for key in pair)
    title = f"{quantity_of(group for band in kept for group in band)} by {names[pair[0]]} and {names[pair[1]]}"
    notes = [without_design(rows), left_out(sum(map(len, bands)) - sum(map(len, kept)), "maps")]
    width = width_for(columns)
    high, left = min(max(0.45 * len(up[1]), 1.2), 3.8), _inches(up[1])
    wide = width / columns - LEFT_OF_AXES - RIGHT_OF_AXES - left - BAR
    below = 0.55 + (_inches(across[1]) if _upright(across[1], wide * POINTS_PER_INCH) else 0.2)
    page = sheet(width, len(kept) * (ABOVE_AXES + high + below), title, notes)
    for k, band in enumerate(kept):
        scale = scale_of([row for group in band for row in group.found])
        maps: list[tuple[Axes, QuadMesh]] = []
        for column, group in enumerate(band):
            ax = page.panel(k, column, columns, high, below, in_words(group.settings, names))
            _narrow(ax, left, BAR)
            maps.append((ax, draw_map(ax, group, pair, (across[1], up[1]), scale)))
            ax.set(xlabel=across[0], ylabel=up[0])
        _draw_bar(*maps[-1], band[0].quantity)
    return page.figure


def axes_of_the_map(rows: Sequence[SweepRow]) -> tuple[str, str] | None:
    """Give the two keys that a map shows, across and up; None where fewer than two vary of the device and the search, or freely.

    Of the device before of the search, and keys of many values before those of few.
    """
    keys = varied(rows)
    if len(rows) < SPARSEST * prod(map(len, keys.values())):
        return None
    own = [key for key in keys if not is_asked(key)]
    ranked = sorted(own, key=lambda key: (not key.startswith(("back", "lenses")), -len(keys[key])))
    return (ranked[0], ranked[1]) if len(ranked) > 1 else None


def scale_of(rows: Sequence[SweepRow]) -> Normalize:
    """Give the scale of colours for rows that have designs: logarithmic, unless an error is 0."""
    errors = [figure_of(row) for row in rows]
    low, high = min(errors), max(errors)
    if low <= 0:
        return Normalize(0, high or 1.0)
    # Of a single number it is the middle.
    return LogNorm(low, high) if high > 1.0001 * low else LogNorm(low / 1.01, high * 1.01)


def draw_map(
    ax: Axes, group: Group, keys: tuple[str, str], values: tuple[Sequence[str], Sequence[str]], scale: Normalize
) -> QuadMesh:
    """Draw the error of each pair of values by colour and number; jobs without a design are hatched and say why.

    Args:
        ax: drawn on.
        group: rows of the same settings but for the two keys, their errors in the same unit.
        keys: along x and along y.
        values: of each of them, in order.
        scale: of the colours.

    Returns:
        The cells, for a bar of their colours.
    """
    at = {}
    for row in group.rows:
        settings = dict(row.settings)
        if all(key in settings for key in keys):
            i, k = (each.index(settings[key]) for key, each in zip(keys, values, strict=True))
            at[i, k] = row
    columns, rows = values
    errors = np.full((len(rows), len(columns)), np.nan)
    for (i, k), row in at.items():
        if row.figure is not None:
            errors[k, i] = row.figure
    cells = ax.pcolormesh(
        np.arange(len(columns) + 1), np.arange(len(rows) + 1), np.ma.masked_invalid(errors), cmap=COLOURS, norm=scale
    )
    cells.set_edgecolor(PAPER)
    cells.set_linewidth(1.0)
    _write_cells(ax, at, scale)
    _name_values(ax, columns, rows)
    for side in ax.spines.values():
        side.set_visible(False)
    return cells


def _write_cells(ax: Axes, at: dict[tuple[int, int], SweepRow], scale: Normalize) -> None:
    width, height = paper_size(ax)
    wide, high = width / ax.get_xlim()[1], height / ax.get_ylim()[1]
    numbers = {place: significant(row.figure) for place, row in at.items() if row.figure is not None}
    size = min((_fitting_size(ax, word, wide, high) for word in set(numbers.values())), default=0.0)
    place = {"ha": "center", "va": "center_baseline", "parse_math": False}
    for (i, k), row in at.items():
        if row.figure is None:
            look = {"facecolor": PAPER, "edgecolor": "#d8d8d8", "hatch": "//////", "linewidth": 0}
            ax.add_patch(Rectangle((i, k), 1, 1, **look))
            own, ink = _fitting_size(ax, row.status, wide, high), WARNING
        else:
            own, ink = size, ink_on(to_hex(COLOURS(scale(row.figure))))
        if own >= SMALLEST_PRINT:
            ax.text(i + 0.5, k + 0.5, numbers.get((i, k), row.status), color=ink, fontsize=own, **place)


def _fitting_size(ax: Axes, words: str, width: float, height: float) -> float:
    """Give the size of letters at which words fit a cell of so many points."""
    across, up = text_size(ax, words, fontsize=SMALL_FONT_SIZE)
    return SMALL_FONT_SIZE * min(1.0, (width - 3) / across, (height - 2) / up)


def _name_values(ax: Axes, columns: Sequence[str], rows: Sequence[str]) -> None:
    """Write the values along both axes, upright below where they are too wide, and not all where they are too many."""
    width, height = paper_size(ax)
    upright, need = _upright(columns, width), 1.3 * SMALL_FONT_SIZE
    across = range(0, len(columns), max(1, ceil(need * len(columns) / width)) if upright else 1)
    up = range(0, len(rows), max(1, ceil(need * len(rows) / height)))
    look = {"rotation": 90 if upright else 0, "parse_math": False}
    ax.set_xticks([k + 0.5 for k in across], [shortened(columns[k], LONGEST_TICK) for k in across], **look)
    ax.set_yticks([k + 0.5 for k in up], [shortened(rows[k], LONGEST_TICK) for k in up], parse_math=False)
    ax.tick_params(colors=FAINT, labelcolor=INK, labelsize=SMALL_FONT_SIZE, length=0)


def _bands(rows: Sequence[SweepRow], keys: Sequence[str]) -> list[list[Group]]:
    """Give the groups that have a map each, in a row those that were asked the same."""
    asked, own = [key for key in keys if is_asked(key)], [key for key in keys if not is_asked(key)]
    bands = [
        [each for each in grouped(group.rows, [*asked, *own]) if len(_kinds(each)) == 1]
        for group in grouped(rows, asked)
    ]
    return [band for band in bands if band]


def _kinds(group: Group) -> frozenset[tuple[str | None, str | None]]:
    """Give what the errors of a group are."""
    return frozenset((row.metric, row.unit) for row in group.found)


def _upright(values: Sequence[str], width: float) -> bool:
    """Whether values stand upright below so many points of cells."""
    return _inches(values) * POINTS_PER_INCH + 6 > width / len(values)


def _inches(values: Sequence[str]) -> float:
    """Give the length of the longest value as it is written along an axis."""
    return min(max(map(len, values)), LONGEST_TICK) * LETTER / POINTS_PER_INCH


def _narrow(ax: Axes, left: float, right: float) -> None:
    """Take inches off the left and the right of axes."""
    across = ax.get_figure(root=True).get_size_inches()[0]  # pyright: ignore[reportOptionalMemberAccess] axes drawn on have a figure
    box = ax.get_position()
    ax.set_position((box.x0 + left / across, box.y0, box.width - (left + right) / across, box.height))


def _draw_bar(ax: Axes, cells: QuadMesh, quantity: str) -> None:
    """Draw what the colours stand for at the right of axes."""
    figure, box = ax.get_figure(root=True), ax.get_position()
    assert figure is not None
    across = figure.get_size_inches()[0]
    bar = figure.add_axes((box.x1 + 0.15 / across, box.y0, 0.14 / across, box.height))
    figure.colorbar(cells, cax=bar)
    bar.set_ylabel(quantity, fontsize=SMALL_FONT_SIZE - 1, parse_math=False)
    if isinstance(cells.norm, LogNorm):
        tick_in_plain_numbers(bar.yaxis)
    bar.tick_params(colors=FAINT, labelcolor=INK, labelsize=SMALL_FONT_SIZE - 1, which="both")
    bar.spines["outline"].set_visible(False)
