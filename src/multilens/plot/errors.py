"""How far off the measured depth is at every depth, and which measurement is the best one there."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from multilens.bands import NOTHING, Band, dense_depths, errors_at, winner_bands
from multilens.cues import Measurement
from multilens.fusion import Best
from multilens.layout import Layout
from multilens.metrics import as_quoted
from multilens.plot.axis import draw_grid
from multilens.plot.canvas import paper_size, text_size
from multilens.plot.placing import spread
from multilens.plot.style import FAINT, INK, SMALL_FONT_SIZE, ink_on, measurement_colour, measurement_dashes
from multilens.plot.units import DepthUnit, depth_unit, significant
from multilens.problem import Problem

LOGARITHMIC_SPAN = 4.0
"""Depths that span more than this factor are drawn on logarithmic axes."""

ROUND_DIGITS = (1.0, 2.0, 5.0)

FEW_DECADES = 300.0
"""Factor between the ends of a logarithmic axis below which 2 and 5 are ticked beside the powers of ten."""

NARROW = 400.0
"""Points across, below which the legend has two lines, and the words below the bar too."""

BAR_HEIGHT = 24.0
"""Points."""

LEADER = 9.0
"""Points between the bar and the words above and below it."""


def draw_errors(ax: Axes, problem: Problem, layout: Layout) -> None:
    """Draw the error of every measurement against depth, thin, the least of them bold, and the design's figure, dashed.

    Errors are in the unit of the problem's metric: mm, for relative errors %, for those of 1/Z dioptres. The figure is what the
    metric makes of them all, their root mean square or the worst.

    The bold line has the colour of the measurement that is best there. In focus a lens' error is 0, which a logarithmic axis
    cannot show: the dips are cut at the lower edge. A measurement has no line where it fails. Where more than the best counts, the
    error of all measurements together, or with what is known before any, is a black line. Of a field the errors straight ahead
    are drawn, and the figure of the whole.

    Args:
        ax: drawn on; logarithmic where the depths span more than a factor 4.
        problem: what is asked.
        layout: one layout, not a batch.
    """
    depths, metric = dense_depths(problem, layout), problem.metric
    errors = as_quoted(metric, errors_at(problem, layout, depths), depths).numpy()
    at, least = depths.numpy(), errors.min(axis=0)
    errors, least = (np.where(np.isfinite(curve), curve, np.nan) for curve in (errors, least))
    figure = metric.figure(problem.score(layout).item())
    logarithmic = _set_depth_axis(ax, problem)
    bottom, top = _error_limits(errors, least, figure, logarithmic)
    if logarithmic:
        ax.set_yscale("log")
    ax.set_ylim(bottom, top)
    floor = 1e-3 * bottom if logarithmic else 0.0
    for k, (measurement, row) in enumerate(zip(problem.measurements, np.maximum(errors, floor), strict=True)):
        look = {"color": measurement_colour(measurement), "dashes": measurement_dashes(measurement)}
        ax.plot(at, row, linewidth=0.8, alpha=0.65, zorder=2, gid=curve_name(k), **look)
    # Widest first: a narrow dip must not drown in the round ends of its neighbours.
    measured = [band for band in winner_bands(problem, layout) if band.measurement != NOTHING]
    for band in sorted(measured, key=lambda band: band.near / band.far):
        part = (at > band.near) & (at < band.far)
        # At its ends the least of those that measure on both sides of them: to one that begins there the line would fall.
        own = errors[problem.measurements.index(band.measurement)]
        curves = [(at, row) for row in errors] + [(at[np.isfinite(own)], own[np.isfinite(own)])]
        ends = np.fmin.reduce([np.interp([band.near, band.far], *curve) for curve in curves])
        x, y = np.r_[band.near, at[part], band.far], np.maximum(np.r_[ends[0], least[part], ends[1]], floor)
        look = {"color": measurement_colour(band.measurement), "solid_capstyle": "round", "zorder": 3}
        ax.plot(x, y, linewidth=3.0, marker="o" if len(at) == 1 else None, **look)
    beside_the_best = _beside_the_best(problem, bool(np.isfinite(least).all()))
    if beside_the_best:
        fused = problem.squared_error(layout.to(torch.float64), depths).detach().sqrt()
        ax.plot(at, np.maximum(as_quoted(metric, fused, depths).numpy(), floor), color=INK, linewidth=1.4, zorder=4)
    ax.axhline(figure, color=INK, linewidth=1.0, linestyle=(0, (5, 3)), zorder=4)
    ax.set_ylabel(f"depth error{'' if problem.field is None else ' straight ahead'} ({metric.unit})")
    ax.set_xlabel(f"depth ({depth_unit(problem).name})")
    if logarithmic:
        ax.yaxis.set_major_locator(LogLocator(subs=ROUND_DIGITS if top < FEW_DECADES * bottom else (1.0,)))
        ax.yaxis.set_minor_formatter(NullFormatter())
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    draw_grid(ax)
    _draw_legend(ax, problem, figure, beside_the_best)


def curve_name(measurement: int) -> str:
    """Give the id that the thin curve of a measurement, by its index, has in an SVG file."""
    return f"curve-{measurement + 1}"


def draw_winners(ax: Axes, problem: Problem, layout: Layout) -> None:
    """Draw a bar that names the best measurement at every depth, with the depths at which the lead changes below it.

    A name stands in its band where it fits, else once above the bar; where those are too many, the numbers of the lenses
    alone: 3 for a cue of lens 3, 1-2 for a pair, 3/2 for a second tier. What finds no room even then is left to its colour,
    and a line says how much that is.

    Args:
        ax: drawn on; its limits are set to those of `draw_errors`, its frame is hidden. About 90 points high at least.
        problem: what is asked.
        layout: one layout, not a batch.
    """
    bands = winner_bands(problem, layout)
    _set_depth_axis(ax, problem)
    ax.set_axis_off()
    width, height = paper_size(ax)
    ax.set_ylim(0, height)
    strip = _Strip(ax, *ax.get_xlim(), width, height, 0.47 * height)
    for band in bands:
        near, far = strip.ends(band)
        colour = measurement_colour(band.measurement)
        # Without an edge, which would be all there is to see of a narrow band.
        ax.add_patch(Rectangle((near, strip.bar), far - near, BAR_HEIGHT, facecolor=colour, edgecolor="none"))
    unnamed, short = _name_bands(strip, bands)
    unit = depth_unit(problem)
    best = "best measurement" if isinstance(problem.fusion, Best) else "measurement that tells most"
    caption = f"{best}; it changes at the depths below ({unit.name})"
    depths = [bands[0].near, *(band.far for band in bands)] if bands[0].near < bands[-1].far else [bands[0].near]
    caption += "; numbers are lenses" * short
    left_out = _write_depths(strip, depths, unit, caption if width >= NARROW else caption.replace("; ", "\n", 1))
    if unnamed or left_out:
        words = f"too narrow to label: {unnamed} names, {left_out} depths"
        ax.text(1, 0, words, transform=ax.transAxes, ha="right", fontsize=0.8 * SMALL_FONT_SIZE, color=FAINT)


@dataclass(frozen=True)
class _Strip:
    """Axes with depth across and points upwards, and where the bar stands on them."""

    axes: Axes
    near: float
    far: float
    width: float
    height: float
    bar: float

    def points(self, depth: float) -> float:
        """Give points from the left edge."""
        pixel = self.axes.transData.transform((depth, 0))[0] - self.axes.transData.transform((self.near, 0))[0]
        whole = self.axes.transData.transform((self.far, 0))[0] - self.axes.transData.transform((self.near, 0))[0]
        return float(pixel / whole * self.width)

    def ends(self, band: Band) -> tuple[float, float]:
        """Give the depths between which a band is drawn; one of a single depth fills the bar."""
        return (band.near, band.far) if band.far > band.near else (self.near, self.far)

    def write(self, x: float, y: float, words: str, **look) -> None:
        """Write words at points from the lower left corner."""
        place = {"transform": self.axes.transAxes, "parse_math": False, "fontsize": SMALL_FONT_SIZE}
        self.axes.text(x / self.width, y / self.height, words, **(place | look))

    def leader(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Draw a thin line between two places in points from the lower left corner."""
        x, y = (
            [a[k] / side, b[k] / side] for k, side, a, b in ((0, self.width, start, end), (1, self.height, start, end))
        )
        self.axes.plot(x, y, transform=self.axes.transAxes, color=FAINT, linewidth=0.6, clip_on=False)


def _set_depth_axis(ax: Axes, problem: Problem) -> bool:
    """Set limits, scale and ticks for the depths of a problem; give whether the scale is logarithmic."""
    near, far = problem.depths.min().item(), problem.depths.max().item()
    logarithmic = far > LOGARITHMIC_SPAN * near
    unit = depth_unit(problem)
    if logarithmic:
        ax.set_xscale("log")
        ax.xaxis.set_major_locator(LogLocator(subs=ROUND_DIGITS))
        ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlim(*(near, far) if far > near else (0.95 * near, 1.05 * near))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda depth, _: f"{depth / unit.millimetres:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    return logarithmic


def _error_limits(
    errors: Float[np.ndarray, "k m"], least: Float[np.ndarray, " m"], figure: float, logarithmic: bool
) -> tuple[float, float]:
    """Give limits that show the least error and the figure well, and the others as far as that goes."""
    # Where nothing measures at all, only the figure is left to show.
    worst, largest = (np.nanmax(np.append(curve, 0.0)) for curve in (least, errors))
    highest = max(worst, figure) or 1.0
    largest = max(largest, highest)
    if not logarithmic:
        return 0.0, 1.05 * min(largest, 2.5 * highest)
    positive = least[least > 0]
    typical = np.quantile(positive, 0.05) if len(positive) else highest
    bottom = max(typical / 3, 1e-5 * highest)
    return min(bottom, 0.3 * highest), 1.3 * min(largest, 10 * highest)


def _beside_the_best(problem: Problem, measured_everywhere: bool) -> str:
    """Name what counts at a depth beside the best measurement; empty where nothing does, or so little that it cannot be seen."""
    if not isinstance(problem.fusion, Best):
        return "all together"
    return "with the guess" if problem.prior_error is not None and not measured_everywhere else ""


def _draw_legend(ax: Axes, problem: Problem, figure: float, beside_the_best: str) -> None:
    first = {measurement.cue: measurement for measurement in reversed(problem.measurements)}
    handles = [
        Line2D([], [], color=measurement_colour(m), linewidth=0.9, label=cue) for cue, m in reversed(first.items())
    ]
    handles.append(Line2D([], [], color=FAINT, linewidth=3.0, label="best of all"))
    if beside_the_best:
        handles.append(Line2D([], [], color=INK, linewidth=1.4, label=beside_the_best))
    quoted = f"{problem.metric.name} {significant(figure)} {problem.metric.unit}"
    handles.append(Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (5, 3)), label=quoted))
    narrow = paper_size(ax)[0] < NARROW
    columns = min(len(handles), 3) if narrow else len(handles)
    place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": columns, "borderaxespad": 0.3}
    spaced = narrow or len(handles) < 5
    wide = {"columnspacing": 1.4, "handlelength": 2.4} if spaced else {"columnspacing": 0.9, "handlelength": 1.6}
    legend = ax.legend(handles=handles, frameon=False, fontsize=SMALL_FONT_SIZE, **wide, **place)
    if legend.get_window_extent().width > ax.get_window_extent().width:
        # What is left of it then reaches beyond the scale, where nothing is, and not beyond the figure.
        legend.set_loc("lower right")
        legend.set_bbox_to_anchor((1.0, 1.0))


def _name_bands(strip: _Strip, bands: Sequence[Band]) -> tuple[int, bool]:
    """Write each winner's name in its bands or once above them; give how many stay without, and whether names are short."""
    named, widest = set(), {}
    for band in bands:
        near, far = (strip.points(depth) for depth in strip.ends(band))
        winner = band.measurement
        if text_size(strip.axes, winner.label, fontsize=SMALL_FONT_SIZE)[0] + 6 <= far - near:
            ink = ink_on(measurement_colour(winner))
            strip.write((near + far) / 2, strip.bar + BAR_HEIGHT / 2, winner.label, color=ink, ha="center", va="center")
            named.add(winner)
        elif far - near > widest.get(winner, (0.0, -1.0))[1]:
            widest[winner] = ((near + far) / 2, far - near)
    outside = sorted(((*place, w) for w, place in widest.items() if w not in named), key=lambda waiting: waiting[0])
    places = [middle for middle, _, _ in outside]
    short = _fit(strip, places, [winner.label for _, _, winner in outside]) is None
    words = [_short_name(winner) if short else winner.label for _, _, winner in outside]
    kept, centres = _fit_most(strip, places, words, [length for _, length, _ in outside])
    top = strip.bar + BAR_HEIGHT
    for k, centre in zip(kept, centres, strict=True):
        strip.leader((places[k], top), (centre, top + LEADER))
        strip.write(centre, top + LEADER + 2, words[k], ha="center", va="bottom")
    return len(outside) - len(kept), short


def _short_name(measurement: Measurement) -> str:
    if not measurement.lenses:
        return measurement.label
    lenses = "-".join(str(lens + 1) for lens in measurement.lenses)
    return lenses if " tier " not in measurement.label else f"{lenses}/{(measurement.tier or 0) + 1}"


def _write_depths(strip: _Strip, depths: Sequence[float], unit: DepthUnit, caption: str) -> int:
    """Write the depths where bands meet, below the bar, level or else upright; give how many found no room."""
    places = [strip.points(depth) for depth in depths]
    words = _distinct([depth / unit.millimetres for depth in depths])
    level = _fit(strip, places, words)
    if level is not None:
        kept, centres = range(len(words)), level
    else:
        # The two ends stay in any case; of the others those with the most room around them.
        room = [min(b - a, c - b) for a, b, c in zip(places, places[1:], places[2:], strict=False)]
        kept, centres = _fit_most(strip, places, words, [np.inf, *room, np.inf], upright=True)
    sizes = [text_size(strip.axes, word, fontsize=SMALL_FONT_SIZE) for word in words]
    look = {"ha": "center", "va": "top", "rotation": 0 if level is not None else 90}
    for k, centre in zip(kept, centres, strict=True):
        strip.leader((places[k], strip.bar), (centre, strip.bar - LEADER))
        strip.write(centre, strip.bar - LEADER - 2, words[k], **look)
    below = strip.bar - LEADER - 7 - max(height if level is not None else width for width, height in sizes)
    strip.write(0, below, caption, ha="left", va="top", fontsize=0.9 * SMALL_FONT_SIZE, color=FAINT)
    return len(places) - len(kept)


def _distinct(numbers: Sequence[float]) -> list[str]:
    """Write ascending numbers to three digits that count, to more where two would look alike."""
    words = [significant(number) for number in numbers]
    for digits in (4, 5, 6):
        alike = {word for word in words if words.count(word) > 1}
        words = [
            significant(number, digits) if word in alike else word for number, word in zip(numbers, words, strict=True)
        ]
    return words


def _fit(strip: _Strip, places: Sequence[float], words: Sequence[str], upright: bool = False) -> list[float] | None:
    """Give where words stand side by side, near their places; None where they are too many."""
    sizes = [text_size(strip.axes, word, fontsize=SMALL_FONT_SIZE) for word in words]
    return spread(places, [height + 1.5 if upright else width + 7 for width, height in sizes], 0, strip.width)


def _fit_most(
    strip: _Strip, places: Sequence[float], words: Sequence[str], worth: Sequence[float], upright: bool = False
) -> tuple[list[int], list[float]]:
    """Give which words fit side by side, and where; those of least worth go first."""
    by_worth = sorted(range(len(words)), key=lambda k: worth[k])
    for left_out in range(len(words) + 1):
        kept = sorted(by_worth[left_out:])
        centres = _fit(strip, [places[k] for k in kept], [words[k] for k in kept], upright)
        if centres is not None:
            return kept, centres
    raise AssertionError("no words at all always fit")
