"""The back of a device and a layout of lenses to scale, without a word."""

from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from multilens.back import KeepOut
from multilens.bands import winner_bands
from multilens.constraints import body_radius
from multilens.cues import Measurement
from multilens.geometry.pairs import pair_indices
from multilens.geometry.shape import Shape
from multilens.layout import Layout
from multilens.plot.canvas import Canvas, shape_patch
from multilens.plot.style import FAINT, INK, PAPER, RULE, lens_colour, measurement_colour, tint
from multilens.problem import Problem
from multilens.question import Question


def best_pairs(problem: Question, layout: Layout) -> tuple[Measurement, ...]:
    """Give the pairs of lenses that are best at some depth, the one that is so from the nearest depth first."""
    if not isinstance(problem, Problem):
        return ()
    winners = [band.measurement for band in winner_bands(problem, layout)]
    return tuple(dict.fromkeys(winner for winner in winners if len(winner.lenses) == 2))


def part_name(measurement: Measurement) -> str:
    """Give the id that a lens or a pair has in an SVG file: lens-2, pair-1-2."""
    kind = "lens" if len(measurement.lenses) == 1 else "pair"
    return "-".join([kind, *(str(lens + 1) for lens in measurement.lenses)])


def extent(problem: Question, layout: Layout) -> tuple[float, float, float, float]:
    """Give left, top, right and bottom of what is drawn, mm: of the back, and of lenses that stand off it."""
    left, top, right, bottom = problem.back.outline.bounds
    bodies = body_radius(layout, problem.lenses).tolist()
    for (x, y), body in zip(layout.position.tolist(), bodies, strict=True):
        left, top, right, bottom = min(left, x - body), min(top, y - body), max(right, x + body), max(bottom, y + body)
    return left, top, right, bottom


def draw_outline(canvas: Canvas, outline: Shape) -> None:
    """Draw where lenses may stand."""
    canvas.axes.add_patch(shape_patch(outline, facecolor="#f4f4f2", edgecolor=INK, linewidth=1.4, zorder=1))


def draw_keep_out(canvas: Canvas, keep_out: KeepOut) -> None:
    """Draw where they may not, hatched, and its clearance dotted."""
    hatch = {"facecolor": PAPER, "edgecolor": "#a3a3a3", "hatch": "//////", "linewidth": 0.8}
    canvas.axes.add_patch(shape_patch(keep_out.shape, zorder=2, **hatch))
    if keep_out.clearance > 0:
        grown = Shape(keep_out.shape.core, keep_out.shape.radius + keep_out.clearance)
        look = {"facecolor": "none", "edgecolor": FAINT, "linestyle": ":", "linewidth": 0.7}
        canvas.axes.add_patch(shape_patch(grown, zorder=2, **look))


def draw_lenses(canvas: Canvas, problem: Question, layout: Layout, named: bool = True) -> None:
    """Draw of each lens its body and in it the aperture, in its colour; in an SVG file the body of lens 2 is named lens-2."""
    bodies = body_radius(layout, problem.lenses).tolist()
    for i, (centre, body) in enumerate(zip(layout.position.tolist(), bodies, strict=True)):
        colour = lens_colour(i)
        look = {"facecolor": tint(colour, 0.78), "edgecolor": colour, "linewidth": 0.9}
        canvas.axes.add_patch(Circle(centre, body, zorder=3, gid=f"lens-{i + 1}" if named else None, **look))
        radius = layout.aperture_radius[i].item()
        canvas.axes.add_patch(Circle(centre, radius, facecolor=colour, edgecolor="none", zorder=6))


def draw_baselines(
    canvas: Canvas, layout: Layout, best: tuple[Measurement, ...], width: float = 2.4, named: bool = True
) -> None:
    """Draw a thin line between every two lenses, and one of so many points where a pair is best, named pair-1-2 in an SVG file."""
    centres = [canvas.paper(*centre) for centre in layout.position.tolist()]
    # As one artist: twelve lenses have 66 pairs.
    ends = [[canvas.data(*centres[i]), canvas.data(*centres[j])] for i, j in pair_indices(layout.count).T.tolist()]
    canvas.axes.add_collection(LineCollection(ends, colors=RULE, linewidths=0.6, zorder=2.5))
    for pair in best:
        start, end = (centres[i] for i in pair.lenses)
        look = {"color": measurement_colour(pair), "linewidth": width, "solid_capstyle": "butt"}
        canvas.line(start, end, zorder=4, gid=part_name(pair) if named else None, **look)
