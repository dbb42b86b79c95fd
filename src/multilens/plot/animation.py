"""A search as an animation: lenses come to rest on the back while their error falls."""

from collections.abc import Callable
from io import BytesIO
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image
from torch import Tensor

from multilens.constraints import body_radius
from multilens.layout import Layout
from multilens.plot.axis import draw_grid, tick_in_plain_numbers
from multilens.plot.bare import best_pairs, draw_baselines, draw_keep_out, draw_lenses, draw_outline
from multilens.plot.canvas import Canvas, paper_size
from multilens.plot.convergence import BEST, START
from multilens.plot.style import INK, SMALL_FONT_SIZE, TITLE_FONT_SIZE, style
from multilens.plot.units import significant
from multilens.question import Question
from multilens.robust import as_drawn

SIZE, DOTS_PER_INCH = (8.4, 4.6), 100
"""Inches; a README is some 850 pixels wide."""

EACH, FIRST, LAST = 100, 900, 3500
"""ms that a step, the first and the last picture are seen."""

DECADE = 8.0
"""Errors whose largest is so many times the least stand on a logarithmic scale."""

COLOURS = 256
"""That all pictures share."""

ENDED = "the design, and the baselines that are best at some depth"

MARGIN = 8.0
"""Points around the back."""


class _Picture:
    """Everything that is drawn once, and the parts of it that move."""

    def __init__(self, question: Question, layouts: Layout, heights: np.ndarray, chosen: int, found: Layout) -> None:
        self.problem, self.metric, self.layouts, self.found = as_drawn(question), question.metric, layouts, found
        self.heights, self.chosen, self.last = heights, chosen, heights.shape[1] - 1
        self.reached = float(_figures(question.score(found).reshape(1), question.metric)[0])
        self.figure = Figure(figsize=SIZE, dpi=DOTS_PER_INCH)
        self.canvas = FigureCanvasAgg(self.figure)
        self.head = self.figure.text(0.03, 0.93, "", fontsize=TITLE_FONT_SIZE, parse_math=False)
        self.below = self.figure.text(0.03, 0.865, "", fontsize=SMALL_FONT_SIZE, parse_math=False)
        self._draw_back(self.figure.add_axes((0.02, 0.02, 0.4, 0.81)))
        self._draw_curves(self.figure.add_axes((0.52, 0.12, 0.45, 0.69)))

    def _draw_back(self, axes: Axes) -> None:
        width, height = paper_size(axes)
        left, top, right, bottom = self.problem.back.outline.bounds
        scale = min((width - 2 * MARGIN) / (right - left), (height - 2 * MARGIN) / (bottom - top))
        middle = ((left + right) / 2, (top + bottom) / 2)
        canvas = Canvas.scaled(axes, middle[0] - width / scale / 2, middle[1] - height / scale / 2, scale)
        draw_outline(canvas, self.problem.back.outline)
        for keep_out in self.problem.back.keep_outs:
            draw_keep_out(canvas, keep_out)
        self.others = axes.scatter([], [], s=9, color=START, alpha=0.8, linewidths=0, zorder=2.2)
        before = set(axes.patches)
        draw_lenses(canvas, self.problem, self.layouts[self.chosen][0], named=False)
        circles = [patch for patch in axes.patches if patch not in before]
        self.bodies, self.apertures = circles[::2], circles[1::2]
        drawn = set(axes.get_children())
        draw_baselines(canvas, self.found, best_pairs(self.problem, self.found), named=False)
        self.baselines: list[Artist] = [artist for artist in axes.get_children() if artist not in drawn]

    def _draw_curves(self, axes: Axes) -> None:
        self.curves = LineCollection([], colors=START, linewidths=0.6, alpha=0.6, zorder=1)
        axes.add_collection(self.curves)
        (self.best,) = axes.plot([], [], color=BEST, linewidth=2.4, zorder=3)
        self.line = axes.axhline(self.reached, color=INK, linewidth=1.0, linestyle=(0, (5, 3)), zorder=2)
        healthy = self.heights[np.isfinite(self.heights)]
        low, high = min(healthy.min(), self.reached), np.quantile(healthy, 0.98)
        if low > 0 and high > DECADE * low:
            axes.set_yscale("log")
            tick_in_plain_numbers(axes.yaxis)
            axes.set_ylim(low / 1.15, high * 1.15)
        else:
            axes.set_ylim(low - 0.15 * (high - low), high + 0.05 * (high - low))
        axes.set_xlim(0, max(self.last, 1))
        axes.set_xlabel("step")
        axes.set_ylabel("score" if self.metric is None else f"{self.metric.name} ({self.metric.unit})")
        draw_grid(axes)

    def at(self, step: int) -> Image.Image:
        """Draw a step; the one after the last is what was found."""
        ended, now = step > self.last, min(step, self.last)
        self._move_lenses(self.found if ended else self.layouts[self.chosen][now])
        self.others.set_offsets(self.layouts.position[:, now].flatten(0, 1).numpy())
        self.others.set_visible(not ended)
        self.curves.set_segments([np.column_stack([np.arange(now + 1), height[: now + 1]]) for height in self.heights])
        self.best.set_data(np.arange(now + 1), self.heights[self.chosen, : now + 1])
        for artist in (self.line, *self.baselines):
            artist.set_visible(ended)
        self.head.set_text(self._title(self.reached if ended else float(self.heights[self.chosen, now])))
        self.below.set_text(
            ENDED if ended else f"step {now} of {self.last}: {len(self.heights)} starts settle, the best in colour"
        )
        self.canvas.draw()
        return Image.fromarray(np.asarray(self.canvas.buffer_rgba())).convert("RGB")

    def _move_lenses(self, layout: Layout) -> None:
        radii = body_radius(layout, self.problem.lenses).tolist(), layout.aperture_radius.tolist()
        for circles, sizes in zip((self.bodies, self.apertures), radii, strict=True):
            for circle, centre, radius in zip(circles, layout.position.tolist(), sizes, strict=True):
                circle.set(center=centre, radius=radius)

    def _title(self, height: float) -> str:
        name, unit = ("score", "") if self.metric is None else (self.metric.name, f" {self.metric.unit}")
        lenses = f"{self.found.count} lens{'' if self.found.count == 1 else 'es'}"
        return f"{lenses}, {name} {significant(height, 4)}{unit}"


def animated_search(
    question: Question,
    layouts: Layout,
    scores: Float[Tensor, "s h"],
    chosen: int,
    found: Layout,
    told: Callable[[int, int], None] = lambda drawn, of: None,
) -> bytes:
    """Draw starts that settle, and the design at the end, as an animated GIF; the same input gives the same bytes.

    Args:
        question: what is asked.
        layouts: a batch, of every start at every step.
        scores: of each.
        chosen: the start whose lenses are drawn in colour; of the others only their places are.
        found: the design's layout.
        told: before each picture, how many are drawn and how many there are to be.
    """
    pictures = []
    with style():
        picture = _Picture(question, layouts, _figures(scores, question.metric), chosen, found)
        for step in range(count := picture.last + 2):
            told(step, count)
            pictures.append(picture.at(step))
    # One palette for all: colours of their own would make the pictures flicker.
    palette = _palette(pictures[0], pictures[-1])
    first, *others = (each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures)
    file = BytesIO()
    durations = [FIRST, *[EACH] * (len(others) - 1), LAST]
    first.save(file, "GIF", save_all=True, append_images=others, duration=durations, loop=0)
    return file.getvalue()


def _palette(first: Image.Image, last: Image.Image) -> Image.Image:
    """Give a palette of what two pictures show, paper as white as it is."""
    both = Image.new("RGB", (first.width + last.width, first.height))
    both.paste(first, (0, 0))
    both.paste(last, (first.width, 0))
    palette = both.quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    colours[colours.sum(-1).argmax()] = 255
    palette.putpalette(colours.flatten().tolist())
    return palette


def _figures(scores: Tensor, metric: Any) -> np.ndarray:
    """Give scores as they are read: every metric's figure is the root of its score, or a fixed part of it."""
    numbers = scores.detach().double().cpu().numpy()
    return numbers if metric is None else metric.figure(1.0) * np.sqrt(numbers)
