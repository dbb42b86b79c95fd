"""The back of a device to scale, as seen from behind, with a layout of lenses on it."""

from functools import partial
from math import cos, hypot, pi, sin

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from multilens.back import KeepOut
from multilens.constraints import body_radius
from multilens.cues import Measurement
from multilens.geometry.shape import Shape
from multilens.layout import Layout
from multilens.plot.bare import best_pairs, draw_baselines, draw_keep_out, draw_lenses, draw_outline, extent
from multilens.plot.canvas import Canvas, paper_size, text_size
from multilens.plot.lens_table import LensTable, lens_table
from multilens.plot.placing import Box, Disc, Paper, around, leader_end
from multilens.plot.style import FAINT, INK, PAPER, SMALL_FONT_SIZE, ink_on, lens_colour, measurement_colour
from multilens.plot.units import round_length, significant
from multilens.problem import Problem
from multilens.question import Question

MARGIN = 30.0
"""Around the back, points: room for a label that finds none on it."""

SCALE_BAR_HEIGHT = 26.0
"""Points, below the margin."""

TABLE_GAP = 10.0
"""Points between the margin and the table."""


CAPITAL = 0.72
"""Height of a digit in units of a line's."""


def draw_layout(ax: Axes, problem: Question, layout: Layout) -> None:
    """Draw a back and its lenses to scale, and a table of the lenses beside or below it, whichever leaves the back larger.

    The outline, hatched keep-outs with their names and clearances, of each lens the body (aperture and clearance), the
    aperture and the number, a thin line between every two lenses, and a strong one with its length where the pair is best
    at some depth. Words are placed for the size that the axes have now.

    Args:
        ax: drawn on; its limits and aspect are set, its frame is hidden.
        problem: what is asked; one without depths has no best pair and no foci.
        layout: one layout, not a batch.
    """
    table = _fitting_table(ax, problem, layout, _signs(problem, layout, best_pairs(problem, layout)))
    canvas, paper, corner = _arrange(ax, extent(problem, layout), table)
    _draw(canvas, paper, problem, layout)
    table.draw(canvas, *corner)


def draw_back(ax: Axes, problem: Question, layout: Layout) -> None:
    """Draw what `draw_layout` draws, as large as the axes allow, without the table.

    In an SVG file lens 2 has the id `lens-2` and the strong baseline of lenses 1 and 2 `pair-1-2`.
    """
    width, height = paper_size(ax)
    left, top, right, bottom = extent(problem, layout)
    scale = min((width - 2 * MARGIN) / (right - left), (height - SCALE_BAR_HEIGHT - 2 * MARGIN) / (bottom - top))
    canvas = Canvas.scaled(ax, (left + right - width / scale) / 2, top - MARGIN / scale, scale)
    _draw(canvas, Paper(Box(width / 2, height / 2, width, height)), problem, layout)


def _draw(canvas: Canvas, paper: Paper, problem: Question, layout: Layout) -> None:
    best = best_pairs(problem, layout)
    draw_outline(canvas, problem.back.outline)
    for keep_out in problem.back.keep_outs:
        draw_keep_out(canvas, keep_out)
    draw_lenses(canvas, problem, layout)
    _draw_scale_bar(canvas, paper, problem.back.outline)
    paper.discs += [
        Disc(*canvas.paper(*centre), radius * canvas.scale)
        for centre, radius in zip(layout.position.tolist(), body_radius(layout, problem.lenses).tolist(), strict=True)
    ]
    paper.soft += [partial(_cost_of_rim, canvas, problem.back.outline)]
    paper.soft += [partial(_cost_of_shape, canvas, keep_out.shape) for keep_out in problem.back.keep_outs]
    if isinstance(problem, Problem):
        draw_baselines(canvas, layout, best)
        _write_lengths(canvas, paper, layout, best)
        centres = [canvas.paper(*centre) for centre in layout.position.tolist()]
        paper.soft += [partial(_cost_of_line, *(centres[i] for i in pair.lenses)) for pair in best]
    _write_numbers(canvas, paper, layout)
    for keep_out in problem.back.keep_outs:
        _write_keep_out(canvas, paper, keep_out)


def _signs(problem: Question, layout: Layout, best: tuple[Measurement, ...]) -> tuple[tuple[str, str], ...]:
    signs = [("aperture", "aperture")]
    if any(lens.clearance > 0 for lens in problem.lenses):
        signs.append(("body", "body: aperture and clearance"))
    if best:
        signs.append(("baseline", "baseline of the best pair" if len(best) == 1 else "baselines best at some depth"))
    if isinstance(problem, Problem) and layout.count * (layout.count - 1) // 2 > len(best):
        signs.append(("pairs", "other baselines" if best else "baselines, best at no depth"))
    if problem.back.keep_outs:
        signs.append(("keep-out", "keep-out, its clearance dotted"))
    return tuple(signs)


def _fitting_table(ax: Axes, problem: Question, layout: Layout, signs: tuple[tuple[str, str], ...]) -> LensTable:
    """Make the table as large as other small print, or smaller where so many lenses would not fit the paper."""
    table = lens_table(ax, problem, layout, signs, SMALL_FONT_SIZE)
    width, height = paper_size(ax)
    fit = min(1.0, height / table.height, 0.6 * width / table.width)
    return table if fit == 1 else lens_table(ax, problem, layout, signs, fit * SMALL_FONT_SIZE)


def _arrange(
    ax: Axes, drawn: tuple[float, float, float, float], table: LensTable
) -> tuple[Canvas, Paper, tuple[float, float]]:
    """Give the paper at its scale, what labels may use of it, and where the table goes."""
    width, height = paper_size(ax)
    left, top, right, bottom = drawn
    # The table keeps as much from the right edge: words are a little wider or narrower wherever they are drawn.
    beside = (width - table.width - 2 * TABLE_GAP - 2 * MARGIN, height - SCALE_BAR_HEIGHT - 2 * MARGIN)
    below = (width - 2 * MARGIN, height - table.height - TABLE_GAP - SCALE_BAR_HEIGHT - 2 * MARGIN)
    scales = [max(min(x / (right - left), y / (bottom - top)), 0) for x, y in (beside, below)]
    # On paper too small for anything the back keeps a fifth of it, and words lie over each other.
    scale = max(*scales, 0.2 * min(width / (right - left), height / (bottom - top)))
    drawn_width, drawn_height = (right - left) * scale + 2 * MARGIN, (bottom - top) * scale + 2 * MARGIN
    if scales[0] >= scales[1]:
        from_left = (width - drawn_width - 2 * TABLE_GAP - table.width) / 2
        from_top = (height - drawn_height - SCALE_BAR_HEIGHT) / 2
        corner = (from_left + drawn_width + TABLE_GAP, max((height - table.height) / 2, 0.0))
    else:
        from_left = (width - drawn_width) / 2
        from_top = (height - drawn_height - SCALE_BAR_HEIGHT - TABLE_GAP - table.height) / 2
        corner = ((width - table.width) / 2, from_top + drawn_height + SCALE_BAR_HEIGHT + TABLE_GAP)
    canvas = Canvas.scaled(ax, left - (from_left + MARGIN) / scale, top - (from_top + MARGIN) / scale, scale)
    usable = (drawn_width, drawn_height + SCALE_BAR_HEIGHT)
    return canvas, Paper(Box(from_left + usable[0] / 2, from_top + usable[1] / 2, *usable)), corner


def _write_numbers(canvas: Canvas, paper: Paper, layout: Layout) -> None:
    """Write each lens' number in its aperture, else in its body clear of a baseline, else beside it with a leader."""
    for i, disc in enumerate(paper.discs):
        words, look = str(i + 1), {"fontsize": SMALL_FONT_SIZE, "fontweight": "bold"}
        width, height = text_size(canvas.axes, words, **look)
        aperture, centre = layout.aperture_radius[i].item() * canvas.scale, (disc.x, disc.y)
        across = hypot(width, CAPITAL * height)
        if across / 2 <= aperture:
            canvas.write(*centre, words, color=ink_on(lens_colour(i)), va="center_baseline", **look)
        elif aperture + across <= disc.radius:
            ring = [Box(x, y, width, CAPITAL * height) for x, y in _ring(centre, (aperture + disc.radius) / 2)]
            box = min(ring, key=paper.soft_cost)
            canvas.write(box.x, box.y, words, color=INK, va="center_baseline", **look)
        else:
            box = paper.place(width, height, list(around(centre, disc.radius, width, height, 60.0)), centre)
            _draw_leader(canvas, box, centre, disc.radius)
            canvas.write(box.x, box.y, words, color=INK, **look)


def _ring(centre: tuple[float, float], radius: float) -> list[tuple[float, float]]:
    """Give places around a point, above it first."""
    angles = [pi * k / 4 for k in (6, 2, 0, 4, 7, 5, 1, 3)]
    return [(centre[0] + radius * cos(angle), centre[1] + radius * sin(angle)) for angle in angles]


def _write_lengths(canvas: Canvas, paper: Paper, layout: Layout, best: tuple[Measurement, ...]) -> None:
    """Write the length of each strong baseline on it, or beside it where lenses leave no room on it."""
    for pair in best:
        i, j = pair.lenses
        length = (layout.position[i] - layout.position[j]).norm().item()
        words, look = f"{significant(length, 4)} mm", {"fontsize": SMALL_FONT_SIZE, "color": measurement_colour(pair)}
        width, height = (side + 4 for side in text_size(canvas.axes, words, **look))
        (x0, y0), (x1, y1) = (canvas.paper(*layout.position[k].tolist()) for k in (i, j))
        shares = [0.5 + sign * 0.04 * k for k in range(11) for sign in (1, -1)]
        on_line = [(x0 + share * (x1 - x0), y0 + share * (y1 - y0)) for share in shares]
        free = [at for at in on_line if all(hypot(at[0] - d.x, at[1] - d.y) > d.radius for d in paper.discs)]
        anchor = (free or on_line)[0]
        box = paper.place(width, height, [*on_line, *around(anchor, 4.0, width, height, 120.0)], anchor)
        if (box.x, box.y) not in on_line:
            _draw_leader(canvas, box, anchor, 0.0)
        ground = {"boxstyle": "round,pad=0.15", "facecolor": PAPER, "edgecolor": "none"}
        canvas.write(box.x, box.y, words, bbox=ground, **look)


def _cost_of_line(start: tuple[float, float], end: tuple[float, float], box: Box) -> float:
    return 4.0 * box.meets(start, end)


def _cost_of_shape(canvas: Canvas, shape: Shape, box: Box) -> float:
    whole = canvas.paper_box(shape)
    # What is smaller than a label hides between its corners.
    hidden = whole.width <= box.width and box.covers(whole)
    return 8.0 * bool(hidden or (_depth_of_corners(canvas, shape, box) < 0).any())


def _cost_of_rim(canvas: Canvas, outline: Shape, box: Box) -> float:
    inside = _depth_of_corners(canvas, outline, box) < 0
    return 3.0 * bool(inside.any() and not inside.all())


def _write_keep_out(canvas: Canvas, paper: Paper, keep_out: KeepOut) -> None:
    look = {"fontsize": 0.85 * SMALL_FONT_SIZE, "color": FAINT}
    width, height = (side + 2 for side in text_size(canvas.axes, keep_out.name, **look))
    shape = canvas.paper_box(keep_out.shape)
    anchor = (shape.x, shape.y)
    steps = [0.5 * k for k in range(-8, 9)] if width < shape.width and height < shape.height else []
    inside = [(shape.x + dx * height, shape.y + dy * height) for dx in steps for dy in steps]
    inside.sort(key=lambda at: hypot(at[0] - shape.x, at[1] - shape.y))
    inside = [at for at in inside if (_depth_of_corners(canvas, keep_out.shape, Box(*at, width, height)) < 0).all()]
    # Its own place is the best for its name.
    covered = partial(_cost_of_shape, canvas, keep_out.shape)
    paper.soft.append(lambda box: -covered(box) if (box.x, box.y) in inside else 0.0)
    outside = around(anchor, min(shape.width, shape.height) / 2, width, height, 160.0)
    box = paper.place(width, height, [*inside, *outside], anchor)
    paper.soft.pop()
    if (box.x, box.y) not in inside:
        _draw_leader(canvas, box, anchor, min(shape.width, shape.height) / 2)
    ground = {"boxstyle": "round,pad=0.1", "facecolor": PAPER, "edgecolor": "none"}
    canvas.write(box.x, box.y, keep_out.name, bbox=ground, **look)


def _depth_of_corners(canvas: Canvas, shape: Shape, box: Box) -> Float[np.ndarray, "8"]:
    """Give the signed distance to a shape of the corners of a box and of the middles of its sides, mm."""
    steps = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if (dx, dy) != (0, 0)]
    places = [canvas.data(box.x + dx * box.width / 2, box.y + dy * box.height / 2) for dx, dy in steps]
    x, y = np.array(places).T
    return shape.signed_distance(x, y)


def _draw_leader(canvas: Canvas, box: Box, anchor: tuple[float, float], radius: float) -> None:
    """Draw a line from a label to the rim of what it labels, where there is a way between them."""
    end = leader_end(box, anchor)
    length = hypot(end[0] - anchor[0], end[1] - anchor[1])
    if length > radius + 4:
        share = radius / length
        start = (anchor[0] + share * (end[0] - anchor[0]), anchor[1] + share * (end[1] - anchor[1]))
        canvas.line(start, end, color=FAINT, linewidth=0.6, zorder=7, gid=f"leader-{box.x:.0f}-{box.y:.0f}")


def _draw_scale_bar(canvas: Canvas, paper: Paper, outline: Shape) -> None:
    box = canvas.paper_box(outline)
    length = round_length((outline.bounds[2] - outline.bounds[0]) / 3)
    left, y = box.x - box.width / 2, paper.edge.y + paper.edge.height / 2 - SCALE_BAR_HEIGHT + 4
    right = left + length * canvas.scale
    canvas.line((left, y), (right, y), color=INK, linewidth=1.6, solid_capstyle="butt")
    for x in (left, right):
        canvas.line((x, y - 3), (x, y + 3), color=INK, linewidth=1.0)
    words = f"{length:g} mm"
    width, height = text_size(canvas.axes, words, fontsize=SMALL_FONT_SIZE)
    middle = max((left + right) / 2, left + width / 2)
    canvas.write(middle, y + 4 + height / 2, words, fontsize=SMALL_FONT_SIZE)
    paper.boxes.append(Box(middle, y + 4 + height / 2 - 4, max(width, right - left), height + 10))
