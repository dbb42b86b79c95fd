"""The layouts of a sweep side by side, all to one scale."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from multilens.layout import Layout
from multilens.plot.bare import best_pairs, draw_baselines, draw_keep_out, draw_lenses, draw_outline
from multilens.plot.canvas import POINTS_PER_INCH, Canvas, paper_size, text_size
from multilens.plot.sheet import LEFT, sheet, width_for
from multilens.plot.style import FAINT, INK, RULE, WARNING
from multilens.plot.sweep_front import cheapest, costs_that_vary
from multilens.plot.sweep_groups import questions, short_names, shortened, varied
from multilens.plot.units import round_length, significant
from multilens.question import Question
from multilens.robust import as_drawn
from multilens.sweep_row import UNREADABLE, SweepRow

MOST, MOST_COLUMNS = 48, 8
"""Layouts in one picture, and side by side."""

CAPTION_SIZE, LINE = 7.5, 10.0
"""Points: of the letters below a layout, and from line to line."""

MARGIN = 3.0
"""Points around a layout."""

BASELINE = 1.2
"""Width of the line between the lenses of a best pair, points."""

TALLEST, LEAST, GAP = 2.1, 0.75, 0.16
"""Inches: a layout is high at most, any place is high at least, and left free between two rows."""


def layouts_figure(rows: Sequence[SweepRow], answers: Mapping[int, tuple[Question, Layout]]) -> Figure | None:
    """Draw the layouts of a sweep side by side to one scale; None where there are none.

    Args:
        rows: of the table of a sweep.
        answers: what was asked and the layout that was found, by job, of the rows that `shown` gives.
    """
    panels = [_as_read(row, answers) for row in shown(rows)]
    backs = [answers[row.job][0].back.outline.bounds for row in panels if row.job in answers]
    if not backs:
        return None
    names, columns = short_names(varied(rows)), columns_of(panels)
    width = width_for(1 if columns < 3 else columns)
    across = (width - 2 * LEFT) / max(columns, 2)
    room = [((across - GAP) / (right - left), TALLEST / (bottom - top)) for left, top, right, bottom in backs]
    scale = POINTS_PER_INCH * min(map(min, room))
    bands = [panels[k : k + columns] for k in range(0, len(panels), columns)]
    heights = [max(_height(row, answers, names, scale) for row in band) for band in bands]
    gone = len(rows) - len(panels)
    note = f"{gone} of {len(rows)} jobs are not shown: those that others beat in error and cost, the last ones first"
    title = "1 layout" if len(backs) == 1 else f"{len(backs)} layouts to one scale"
    page = sheet(width, sum(heights) + GAP * len(bands) + 0.45, title, [note] if gone else [])
    top = 0.0
    for band, height in zip(bands, heights, strict=True):
        for k, row in enumerate(band):
            ax, words = page.axes(LEFT + k * across, top, across, height), caption(row, names)
            if row.job in answers:
                draw_small_layout(ax, *answers[row.job], scale, words)
            else:
                draw_no_layout(ax, words)
        top += height + GAP
    longest = max(right - left for left, _, right, _ in backs)
    draw_scale_bar(page.axes(LEFT, top, 3.0, 0.3), scale, longest / 2)
    return page.figure


def _as_read(row: SweepRow, answers: Mapping[int, tuple[Question, Layout]]) -> SweepRow:
    """Give a row as it is, or without its figure where its design could not be read."""
    lost = row.figure is not None and row.job not in answers
    return replace(row, figure=None, status=UNREADABLE) if lost else row


def _height(
    row: SweepRow, answers: Mapping[int, tuple[Question, Layout]], names: Mapping[str, str], scale: float
) -> float:
    """Give the inches that a row's layout and its caption take."""
    bounds = answers[row.job][0].back.outline.bounds if row.job in answers else (0.0, 0.0, 0.0, 0.0)
    points = (bounds[3] - bounds[1]) * scale + 2 * MARGIN + LINE * len(caption(row, names))
    return max(points / POINTS_PER_INCH, LEAST)


def shown(rows: Sequence[SweepRow], most: int = MOST) -> tuple[SweepRow, ...]:
    """Give the rows that a picture of so many layouts shows: all, or first those that no other beats in what it costs.

    The others that fit are the first ones of the sweep; all are given in its order.
    """
    if len(rows) <= most:
        return tuple(rows)
    best = {
        row.job
        for group in questions(rows)
        for cost in costs_that_vary(group.found)
        for row in cheapest(group.found, cost)
    }
    ranked = sorted(rows, key=lambda row: (row.job not in best, row.figure is None))
    kept = {row.job for row in ranked[:most]}
    return tuple(row for row in rows if row.job in kept)


def columns_of(rows: Sequence[SweepRow]) -> int:
    """Give how many layouts stand side by side: the values of the key that changes fastest, or a multiple, as far as that goes."""
    fastest = len(list(varied(rows).values())[-1]) if varied(rows) else 1
    if not 3 <= fastest <= MOST_COLUMNS or len(rows) > 6 * fastest:
        fastest = max(1, MOST_COLUMNS // fastest) * fastest if fastest <= MOST_COLUMNS else MOST_COLUMNS
    return min(fastest, len(rows))


def caption(row: SweepRow, names: Mapping[str, str]) -> list[str]:
    """Give the lines below a layout: its job with the error, and the value of every key in `names`."""
    told = row.status if row.figure is None else f"{significant(row.figure)} {row.unit or ''}".rstrip()
    settings = dict(row.settings)
    return [f"{row.job}: {told}", *(f"{name} {settings[key]}" for key, name in names.items() if key in settings)]


def draw_small_layout(ax: Axes, question: Question, layout: Layout, scale: float, lines: Sequence[str]) -> None:
    """Draw a back with its lenses to a given scale, and a caption below it.

    Args:
        ax: drawn on; its limits and aspect are set, its frame is hidden. The caption goes to its foot.
        question: what was asked.
        layout: one layout, not a batch.
        scale: points on the paper per mm.
        lines: of the caption, shortened to the width of the axes.
    """
    problem = as_drawn(question)
    width, height = paper_size(ax)
    left, _, right, bottom = problem.back.outline.bounds
    drawn = height - len(lines) * LINE
    corner = ((left + right) / 2 - width / 2 / scale, bottom - (drawn - MARGIN) / scale)
    canvas = Canvas.scaled(ax, *corner, scale)
    draw_outline(canvas, problem.back.outline)
    for keep_out in problem.back.keep_outs:
        draw_keep_out(canvas, keep_out)
    draw_lenses(canvas, problem, layout, named=False)
    draw_baselines(canvas, layout, best_pairs(problem, layout), BASELINE, named=False)
    _write_caption(canvas, lines, drawn, INK)


def draw_no_layout(ax: Axes, lines: Sequence[str]) -> None:
    """Draw in the place of a layout that there is none, with a caption that says why."""
    width, height = paper_size(ax)
    canvas = Canvas.scaled(ax, 0.0, 0.0, 1.0)
    drawn = height - len(lines) * LINE
    middle, side = (width / 2, drawn - MARGIN - 10), 8.0
    for dx in (-side, side):
        canvas.line((middle[0] - dx, middle[1] - side), (middle[0] + dx, middle[1] + side), color=RULE, linewidth=1.5)
    _write_caption(canvas, lines, drawn, WARNING)


def draw_scale_bar(ax: Axes, scale: float, longest: float) -> None:
    """Draw a bar of a round length, at most so many mm, at the left of axes."""
    _, height = paper_size(ax)
    canvas, length = Canvas.scaled(ax, 0.0, 0.0, 1.0), round_length(longest)
    y, right = height / 2, 1 + length * scale
    canvas.line((1.0, y), (right, y), color=INK, linewidth=1.6, solid_capstyle="butt")
    for x in (1.0, right):
        canvas.line((x, y - 3), (x, y + 3), color=INK, linewidth=1.0)
    canvas.write(right + 6, y, f"{length:g} mm", ha="left", fontsize=9.0)


def _write_caption(canvas: Canvas, lines: Sequence[str], top: float, colour: str) -> None:
    width, _ = paper_size(canvas.axes)
    for k, line in enumerate(lines):
        look = {
            "fontsize": CAPTION_SIZE,
            "color": colour if k == 0 else FAINT,
            "fontweight": "bold" if k == 0 else "normal",
        }
        canvas.write(width / 2, top + (k + 0.5) * LINE, _fitting(canvas.axes, line, width - 4, **look), **look)


def _fitting(ax: Axes, words: str, width: float, **look) -> str:
    """Shorten words until they fit a width in points."""
    wide = text_size(ax, words, **look)[0]
    letters = len(words)
    while wide > width and letters > 4:
        letters = min(letters - 1, int(letters * width / wide))
        wide = text_size(ax, shortened(words, max(letters, 4)), **look)[0]
    return shortened(words, max(letters, 4))
