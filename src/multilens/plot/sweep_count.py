"""What each further lens gains: the error against the number of lenses, and below it what no layout reaches."""

from collections.abc import Mapping, Sequence
from math import ceil
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from multilens.plot.axis import draw_grid, tick_in_plain_numbers
from multilens.plot.labels import Labels
from multilens.plot.sheet import ABOVE_AXES, sheet, width_for
from multilens.plot.style import FAINT, INK, RULE, SMALL_FONT_SIZE, shade
from multilens.plot.sweep_groups import (
    Group,
    in_words,
    left_out,
    quantity_of,
    questions,
    short_names,
    varied,
    without_design,
)
from multilens.plot.sweep_lines import MOST_LINES, Line, Name, colours, lines
from multilens.sweep_row import SweepRow

MARK = 5.0
"""Size of a point, points."""

MOST_LABELLED, REACH, PRINT = 3, 30.0, SMALL_FONT_SIZE - 1
"""Lines whose steps are labelled, points that a label may be off its step, and size of its letters."""

MINUS = "\N{MINUS SIGN}"

LOWEST = 3.0
"""By so much a bound may be below the least error and still be on the picture."""

FAILED_ROOM = 0.04
"""Part of the height that the marks of each line without a design take at the foot."""

MOST_PANELS, BELOW = 6, 0.66
"""Panels in a figure, and inches below each."""


def count_figure(rows: Sequence[SweepRow]) -> Figure | None:
    """Draw error against the number of lenses, a panel for everything that was asked; None where that number does not vary.

    Args:
        rows: of the table of a sweep.
    """
    every = [(question, lines(question, rows)) for question in questions(rows)]
    several = [(question, found) for question, found in every if any(len(line.best) > 1 for line in found)]
    if not several:
        return None
    panels, names = several[:MOST_PANELS], short_names(varied(rows))
    colour = colours([line for _, found in panels for line in found])
    notes = [without_design(rows), left_out(len(several) - len(panels), "questions")]
    columns = {4: 2}.get(len(panels), min(len(panels), 3))
    high, bands = (4.3 if len(panels) == columns else 3.5), ceil(len(panels) / columns)
    title = f"{quantity_of([question for question, _ in panels])} by the number of lenses"
    key = _key(panels, colour, names)
    page = sheet(width_for(columns), bands * (ABOVE_AXES + high + BELOW), title, notes, key)
    unlabelled = 0
    for k, (question, found) in enumerate(panels):
        ax = page.panel(k // columns, k % columns, columns, high, BELOW, in_words(question.settings, names))
        unlabelled += draw_error_by_count(ax, question.quantity, found, colour)
    page.say_below(left_out(unlabelled, "labels, for want of room"))
    return page.figure


def draw_error_by_count(ax: Axes, quantity: str, drawn: Sequence[Line], colour: Mapping[Name, str]) -> int:
    """Draw error against the number of lenses, line by line, the bounds below it, and what each step changes in per cent.

    Args:
        ax: drawn on; logarithmic where all errors are above 0. Labels are placed for the size that it has now.
        quantity: what the error is, with its unit.
        drawn: lines in the same unit.
        colour: of a line by its name; one without is grey. The changes are written at the best `MOST_LABELLED` of the others.

    Returns:
        How many changes are not written, for want of room.
    """
    ax.set(xlabel="lenses", ylabel=quantity)
    _set_limits(ax, drawn)
    labels, named = Labels(ax), [line for line in drawn if line.name in colour]
    found = [line for line in drawn if line.best]
    for line in found:
        look = {"color": colour.get(line.name, RULE), "zorder": 3 if line in named else 2}
        ax.plot(*_columns(line.points), marker="o", markersize=MARK, linewidth=1.8, **look)
        ax.plot(*_columns(line.bounds), marker="_", markersize=9, linewidth=1.0, linestyle=":", **look)
    for line in named:
        for point in line.points:
            labels.keep_off(*point, MARK / 2 + 1)
        labels.rather_not_on(line.points)
        labels.rather_not_on(line.bounds)
    for k, line in enumerate(line for line in named if line.failed):
        marks = {"linestyle": "none", "marker": "x", "markersize": MARK + 1, "color": colour[line.name]}
        ax.plot(line.failed, [0.02 + 0.03 * k] * len(line.failed), transform=ax.get_xaxis_transform(), **marks)
    best = sorted((line for line in named if line.best), key=lambda line: min(figure for _, figure in line.points))[
        :MOST_LABELLED
    ]
    steps = [(line, *gain) for line in best for gain in line.gains]
    written = [
        labels.write(x, y, percent(change), 2.0, REACH, color=shade(colour[line.name], 0.3), fontsize=PRINT)
        for line, x, y, change in steps
    ]
    return sum(len(line.gains) for line in drawn) - sum(written)


def percent(change: float) -> str:
    """Write a change as per cent to two digits, with a sign; less than a hundredth of a per cent is none."""
    if abs(change) < 1e-4:
        return "0 %"
    size = 100 * abs(change)
    return f"{MINUS if change < 0 else '+'}{f'{size:.0f}' if size >= 10 else f'{size:.2g}'} %"


def _key(
    panels: Sequence[tuple[Group, Sequence[Line]]], colour: Mapping[Name, str], names: Mapping[str, str]
) -> list[Artist]:
    every = [line for _, found in panels for line in found]
    look: dict[str, Any] = {"marker": "o", "markersize": MARK, "linewidth": 1.8}
    nothing: dict[str, Any] = {"marker": "x", "linestyle": "none"}
    drawn = {line.name for line in every if line.best}
    key: list[Artist] = [
        Line2D([], [], color=each, label=in_words(name, names) or "found", **(look if name in drawn else nothing))
        for name, each in colour.items()
    ]
    grey = len({line.name for line in every} - colour.keys())
    if grey:
        key.append(Line2D([], [], color=RULE, label=f"{grey} more, not as good", **look))
    if any(line.bounds for line in every):
        look = {"color": FAINT, "marker": "_", "markersize": 9, "linewidth": 1.0, "linestyle": ":"}
        key.append(Line2D([], [], label="no layout is below", **look))
    if any(line.failed for line in every):
        key.append(Line2D([], [], color=FAINT, marker="x", linestyle="none", label="no design"))
    return key


def _set_limits(ax: Axes, drawn: Sequence[Line]) -> None:
    counts = [count for line in drawn for count, _ in line.points] + [count for line in drawn for count in line.failed]
    errors = [error for line in drawn for _, error in line.points]
    shown = errors + [max(bound, min(errors) / LOWEST) for line in drawn for _, bound in line.bounds]
    ax.set_xlim(min(counts) - 0.5, max(counts) + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    failed = min(sum(bool(line.failed) for line in drawn), MOST_LINES)
    if min(errors) > 0:
        ax.set_yscale("log")
        span = max(max(shown) / min(shown), 1.02)
        ax.set_ylim(min(shown) / span ** (0.1 + FAILED_ROOM * failed), max(shown) * span**0.1)
        tick_in_plain_numbers(ax.yaxis)
    else:
        ax.set_ylim(0, 1.1 * max(errors) or 1.0)
    draw_grid(ax)
    ax.tick_params(colors=FAINT, labelcolor=INK)


def _columns(points: Sequence[tuple[float, float]]) -> tuple[list[float], list[float]]:
    return [x for x, _ in points], [y for _, y in points]
