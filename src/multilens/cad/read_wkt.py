"""Well-known text: one polygon or multipolygon a line, the outline first, then keep-outs."""

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon
from shapely.errors import ShapelyError
from shapely.geometry.base import BaseGeometry

from multilens.cad.curve import Curve, tidy
from multilens.cad.drawing import Drawing, Part
from multilens.cad.layers import KEEP_OUTS, OUTLINE
from multilens.cad.units import scale_of

MOST_LINES = 1000


# What is not finite numpy warns of; a curve refuses it.
@np.errstate(all="ignore")
def read_wkt(text: str, units: str | None) -> Drawing:
    """Read the geometries of a text, y upwards.

    Args:
        text: of the file.
        units: told by the user; the file has none.

    Raises:
        ValueError: a line is no polygon, or the units are unknown.
    """
    factor = scale_of(units, None, "well-known text has none", "units=mm")
    lines = [line for line in text.splitlines() if line.strip()]
    if len(lines) > MOST_LINES:
        raise ValueError(f"well-known text must be at most {MOST_LINES} lines, got {len(lines)}")
    parts = []
    for number, line in enumerate(lines, 1):
        try:
            geometry = shapely.from_wkt(line)
        except ShapelyError as error:
            raise ValueError(f"line {number} must be well-known text, got {line[:40]!r}: {error}") from None
        parts.append(Part((KEEP_OUTS if parts else OUTLINE,), curves_of(geometry, factor, f"line {number}")))
    return Drawing(tuple(parts), y_up=True)


def curves_of(geometry: BaseGeometry, factor: float, where: str) -> tuple[Curve, ...]:
    """Give the rings of a polygon or multipolygon as curves.

    Args:
        geometry: anything of shapely's.
        factor: mm per unit.
        where: it stands in the file, to be named.

    Raises:
        ValueError: it is something else, or empty.
    """
    if not isinstance(geometry, Polygon | MultiPolygon) or geometry.is_empty:
        got = "an empty one" if geometry.is_empty else f"a {geometry.geom_type}"
        raise ValueError(f"{where} must be a Polygon or MultiPolygon, got {got}")
    polygons = [geometry] if isinstance(geometry, Polygon) else geometry.geoms
    rings = [ring for polygon in polygons for ring in (polygon.exterior, *polygon.interiors)]
    points = [factor * shapely.get_coordinates(ring) for ring in rings]
    return tuple(tidy(ring, np.zeros(len(ring))) for ring in points)
