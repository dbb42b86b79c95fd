"""Axes as a sheet of paper: a drawing to scale on it, and room beside the drawing for words."""

from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.text import Text

from multilens.geometry.shape import Shape
from multilens.plot.placing import Box

POINTS_PER_INCH = 72.0


@dataclass(frozen=True)
class Canvas:
    """Axes whose data are millimetres of a back, x to the right and y down, alike in both directions.

    Places on the paper are points from the top left corner of the axes, right and down.

    Args:
        axes: drawn on; its limits are set by `scaled`.
        left: x at the left edge of the paper, mm.
        top: y at its top edge, mm.
        scale: points on the paper per mm.
    """

    axes: Axes
    left: float
    top: float
    scale: float

    @classmethod
    def scaled(cls, axes: Axes, left: float, top: float, scale: float) -> "Canvas":
        """Set the limits of axes so that the paper begins at this point of the back and has this scale."""
        width, height = paper_size(axes)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_axis_off()
        axes.set_xlim(left, left + width / scale)
        axes.set_ylim(top + height / scale, top)
        return cls(axes, left, top, scale)

    def data(self, x: float, y: float) -> tuple[float, float]:
        """Give the millimetres at a place on the paper."""
        return self.left + x / self.scale, self.top + y / self.scale

    def paper(self, x: float, y: float) -> tuple[float, float]:
        """Give the place on the paper of a point of the back."""
        return (x - self.left) * self.scale, (y - self.top) * self.scale

    def paper_box(self, shape: Shape) -> Box:
        """Give the bounding box of a shape on the paper."""
        (left, top), (right, bottom) = self.paper(*shape.bounds[:2]), self.paper(*shape.bounds[2:])
        return Box((left + right) / 2, (top + bottom) / 2, right - left, bottom - top)

    def write(self, x: float, y: float, words: str, **look: Any) -> Text:
        """Write words at a place on the paper, centred unless told otherwise; no dollar sign starts a formula."""
        place = {"ha": "center", "va": "center", "parse_math": False, "zorder": 10}
        return self.axes.text(*self.data(x, y), words, **(place | look))

    def line(self, start: tuple[float, float], end: tuple[float, float], **look: Any) -> None:
        """Draw a straight line between two places on the paper."""
        (x0, y0), (x1, y1) = self.data(*start), self.data(*end)
        self.axes.plot([x0, x1], [y0, y1], **look)


def paper_size(axes: Axes) -> tuple[float, float]:
    """Give width and height of axes, points."""
    box, dpi = axes.get_window_extent(), axes.get_figure(root=True).dpi  # pyright: ignore[reportOptionalMemberAccess] axes drawn on have a figure
    return float(box.width * POINTS_PER_INCH / dpi), float(box.height * POINTS_PER_INCH / dpi)


def text_size(axes: Axes, words: str, **look: Any) -> tuple[float, float]:
    """Give width and height of words as they will be drawn, points."""
    dpi = axes.get_figure(root=True).dpi  # pyright: ignore[reportOptionalMemberAccess] axes drawn on have a figure
    text = axes.text(0, 0, words, parse_math=False, **look)
    box = text.get_window_extent()
    text.remove()
    return float(box.width * POINTS_PER_INCH / dpi), float(box.height * POINTS_PER_INCH / dpi)


def shape_patch(shape: Shape, **look: Any) -> PathPatch:
    """Give a shape as a patch, with its holes and parts."""
    polygon = shape.polygon(segments_per_quarter=24)
    rings = []
    for part in getattr(polygon, "geoms", [polygon]):
        # The filling rule counts turns: a hole must run against its shell.
        shells = [list(part.exterior.coords)[:: 1 if part.exterior.is_ccw else -1]]
        holes = [list(ring.coords)[:: -1 if ring.is_ccw else 1] for ring in part.interiors]
        rings += shells + holes
    return PathPatch(Path.make_compound_path(*(Path(ring, closed=True) for ring in rings)), **look)
