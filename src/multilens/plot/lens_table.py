"""The table beside the drawing of a back: every lens with its foci and aperture, and what the signs mean."""

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from multilens.layout import Layout
from multilens.lens import telling_names
from multilens.optics.thin_lens import f_number
from multilens.plot.canvas import Canvas, text_size
from multilens.plot.style import FAINT, RULE, ink_on, lens_colour, tint
from multilens.plot.sweep_groups import shortened
from multilens.plot.units import depth_unit, significant
from multilens.problem import Problem
from multilens.question import Question

FOCI_IN_A_LINE, LONGEST_NAME = 4, 24

LINE = 1.45
"""Height of a line in units of the font size."""

SPACE = 1.4
"""Between columns, in units of the font size."""


@dataclass(frozen=True)
class LensTable:
    """A table that knows its size.

    Args:
        head: of each column.
        rows: one for each lens.
        signs: what is explained below, as kind of sign and words.
        columns: width of each, points.
        font_size: points.
    """

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    signs: tuple[tuple[str, str], ...]
    columns: tuple[float, ...]
    font_size: float

    @property
    def width(self) -> float:
        """Points."""
        return sum(self.columns) + SPACE * self.font_size * (len(self.columns) - 1)

    @property
    def height(self) -> float:
        """Points."""
        return _height(self.rows, self.signs) * self.font_size

    def draw(self, canvas: Canvas, left: float, top: float) -> None:
        """Write the table with its top left corner at a place on the paper."""
        size, y = self.font_size, top
        x = [left + sum(self.columns[:k]) + SPACE * size * k for k in range(len(self.columns))]
        for column, words in zip(x, self.head, strict=True):
            canvas.write(column, y + 1.3 * size, words, ha="left", fontsize=0.85 * size, color=FAINT, linespacing=1.1)
        y += 2.8 * size
        canvas.line((left, y), (left + self.width, y), color=RULE, linewidth=0.8)
        y += 0.2 * size
        for i, row in enumerate(self.rows):
            middle = y + LINE * size / 2
            self._number(canvas, i, x[0] + self.columns[0] / 2, middle)
            for column, words in zip(x[1:], row[1:], strict=True):
                for k, line in enumerate(words.split("\n")):
                    canvas.write(column, middle + k * LINE * size, line, ha="left", va="center_baseline", fontsize=size)
            y += _lines(row) * LINE * size
        y += 0.9 * size
        for kind, words in self.signs:
            middle = y + LINE * size / 2
            _draw_sign(canvas, kind, left + size, middle, size)
            canvas.write(left + 2.6 * size, middle, words, ha="left", fontsize=0.85 * size, color=FAINT)
            y += LINE * size

    def _number(self, canvas: Canvas, lens: int, x: float, y: float) -> None:
        colour, size = lens_colour(lens), self.font_size
        place_x, place_y = canvas.data(x, y)
        canvas.axes.plot([place_x], [place_y], marker="o", markersize=1.25 * size, color=colour, markeredgewidth=0)
        look = {"fontsize": 0.8 * size, "fontweight": "bold", "color": ink_on(colour), "va": "center_baseline"}
        canvas.write(x, y, str(lens + 1), **look)


def lens_table(
    axes: Axes, problem: Question, layout: Layout, signs: tuple[tuple[str, str], ...], font_size: float
) -> LensTable:
    """Make the table of a layout.

    Args:
        axes: it will be drawn on.
        problem: what is asked; without depths there is nothing to focus on and no such column.
        layout: one layout, not a batch.
        signs: kind ("body", "aperture", "baseline", "pairs", "keep-out") and words of what is explained.
        font_size: points.
    """
    head, rows = ["lens"], [[str(i + 1)] for i in range(layout.count)]
    names = telling_names(problem.lenses)
    if names:
        head.append("name")
        for row, name in zip(rows, names, strict=True):
            row.append(shortened(name, LONGEST_NAME))
    if isinstance(problem, Problem):
        unit = depth_unit(problem)
        head.append(f"focus\nZf ({unit.name})")
        for row, lens, foci in zip(rows, problem.lenses, layout.focus.tolist(), strict=True):
            numbers = [unit.number(focus) for focus in foci[: lens.tiers]]
            lines = [numbers[k : k + FOCI_IN_A_LINE] for k in range(0, len(numbers), FOCI_IN_A_LINE)]
            row.append("\n".join("  ".join(line) for line in lines))
    head.append("radius\nA (mm)")
    for row, radius in zip(rows, layout.aperture_radius.tolist(), strict=True):
        row.append(significant(radius))
    if isinstance(problem, Problem):
        head.append("f-number\nf / 2A")
        for row, lens, radius in zip(rows, problem.lenses, layout.aperture_radius, strict=True):
            row.append(significant(f_number(radius.new_tensor(lens.focal_length), radius).item()))
    cells = tuple(tuple(row) for row in rows)
    columns = [2.0 * font_size] + [
        max(
            text_size(axes, head[k], fontsize=0.85 * font_size)[0],
            *(text_size(axes, row[k], fontsize=font_size)[0] for row in cells),
        )
        for k in range(1, len(head))
    ]
    explained = [text_size(axes, words, fontsize=0.85 * font_size)[0] + 2.6 * font_size for _, words in signs]
    missing = max(explained, default=0.0) - sum(columns) - SPACE * font_size * (len(columns) - 1)
    columns[-1] += max(missing, 0.0)
    return LensTable(tuple(head), cells, signs, tuple(columns), font_size)


def _lines(row: tuple[str, ...]) -> int:
    return max(words.count("\n") + 1 for words in row)


def _height(rows: tuple[tuple[str, ...], ...], signs: tuple[tuple[str, str], ...]) -> float:
    return 3.0 + LINE * sum(map(_lines, rows)) + (0.9 + LINE * len(signs) if signs else 0)


def _draw_sign(canvas: Canvas, kind: str, x: float, y: float, size: float) -> None:
    (left, at_y), (right, _), (middle, _) = canvas.data(x - size, y), canvas.data(x + size, y), canvas.data(x, y)
    axes = canvas.axes
    if kind == "aperture":
        axes.plot([middle], [at_y], marker="o", markersize=0.7 * size, color=FAINT, markeredgewidth=0)
    elif kind == "body":
        look = {"color": tint(FAINT, 0.82), "markeredgecolor": FAINT, "markeredgewidth": 0.8}
        axes.plot([middle], [at_y], marker="o", markersize=1.1 * size, **look)
    elif kind == "keep-out":
        corner = canvas.data(x - size, y + 0.45 * size)
        width, height = 2 * size / canvas.scale, -0.9 * size / canvas.scale
        look = {"facecolor": "none", "edgecolor": FAINT, "hatch": "//////", "linewidth": 0.6}
        axes.add_patch(Rectangle(corner, width, height, **look))
    else:
        axes.plot([left, right], [at_y, at_y], color=FAINT, linewidth=2.4 if kind == "baseline" else 0.6)
