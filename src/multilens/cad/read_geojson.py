"""GeoJSON: polygons by layer; our own files say their units, and what round corners are exactly."""

import json
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.errors import ShapelyError
from shapely.geometry import shape as geometry_of

from multilens.cad.curve import Curve
from multilens.cad.drawing import Drawing, Part
from multilens.cad.layers import OUTLINE
from multilens.cad.read_wkt import curves_of
from multilens.cad.rims import rims
from multilens.cad.units import MILLIMETRES, scale_of
from multilens.fields import number
from multilens.geometry.shape import Shape

MOST_FEATURES = 10_000
ALTERED = 1e-6
"""mm; a geometry that differs by more from the core that it is said to be grown from was altered."""


# What is not finite numpy warns of; a curve refuses it.
@np.errstate(all="ignore")
def read_geojson(text: str, units: str | None) -> Drawing:
    """Read the polygons of a FeatureCollection, a Feature or a geometry, y upwards.

    A feature can be asked for by its property `layer`, else by its `name` or `id`. A bare geometry is the outline.

    Args:
        text: of the file.
        units: told by the user; None for files that say them, which only ours do: others are in degrees or unknown.

    Raises:
        ValueError: it is no GeoJSON, a feature is damaged, or the units are unknown.
    """
    content = record_of(text)
    found = content.get("units")
    if found is not None and found not in MILLIMETRES:
        raise ValueError(f"units must be one of {', '.join(MILLIMETRES)}, got {found!r:.40} in the file")
    factor = scale_of(
        units, None if found is None else MILLIMETRES[found], "GeoJSON is in degrees unless told otherwise", "units=mm"
    )
    kind = content.get("type")
    if kind not in ("FeatureCollection", "Feature"):
        return Drawing((Part((OUTLINE,), curves_of(_geometry(content, kind), factor, "geometry")),), y_up=True)
    features = content.get("features") if kind == "FeatureCollection" else [content]
    if not isinstance(features, list) or len(features) > MOST_FEATURES:
        raise ValueError(f"features must be a list of at most {MOST_FEATURES}, got {type(features).__name__}")
    parts = [_part(feature, factor, f"features[{index}]") for index, feature in enumerate(features)]
    return Drawing(tuple(part for part in parts if part is not None), y_up=True)


def record_of(text: str) -> dict[str, Any]:
    """Read a JSON record.

    Raises:
        ValueError: it is none, nested too deep, or holds what is no finite number.
    """

    def refuse(constant: str) -> None:
        raise ValueError(f"GeoJSON must hold finite numbers, got {constant}")

    try:
        content = json.loads(text, parse_constant=refuse)
    except json.JSONDecodeError as error:
        raise ValueError(f"GeoJSON must be whole JSON, got {error.msg} in line {error.lineno}") from None
    except RecursionError:
        raise ValueError("GeoJSON must not be nested so deep") from None
    if not isinstance(content, dict):
        raise ValueError(f"GeoJSON must be a record, got a {type(content).__name__}")
    return content


def _part(feature: object, factor: float, where: str) -> Part | None:
    """Give a feature as a part of the drawing; None for one without a geometry."""
    if not isinstance(feature, dict) or not isinstance(properties := feature.get("properties") or {}, dict):
        raise ValueError(f"{where} must be a feature with properties, got a {type(feature).__name__}")
    own = {str(key).casefold(): value for key, value in properties.items()}
    geometry, name = feature.get("geometry"), str(own.get("name") or feature.get("id") or "")
    if geometry is None:
        return None
    kind = geometry.get("type") if isinstance(geometry, dict) else None
    layers = (str(own.get("layer") or name),)
    if kind not in ("Polygon", "MultiPolygon"):
        return Part(layers, fault=f"{where} must be a Polygon or MultiPolygon, got a {kind!r:.40}")
    try:
        curves = curves_of(_geometry(geometry, kind), factor, where)
        if "core" in own:
            curves = _exact(own, curves, factor, where)
    except ValueError as error:
        return Part(layers, fault=str(error))
    clearance = own.get("clearance")
    return Part(layers, curves, name, None if clearance is None else factor * number(clearance, f"{where}.clearance"))


def _geometry(content: Any, kind: object) -> Any:
    """Read a geometry; whatever shapely stumbles over is refused."""
    try:
        return geometry_of(content)
    except (ShapelyError, OverflowError, AttributeError, KeyError, TypeError, ValueError, IndexError) as error:
        raise ValueError(f"GeoJSON must be well formed, got a damaged {kind!r:.40}: {error}") from None


def _exact(own: dict[str, Any], drawn: tuple[Curve, ...], factor: float, where: str) -> tuple[Curve, ...]:
    """Give the rim of the core that a feature says it is grown from, refused where it is not that of its geometry."""
    core = _geometry(own["core"], "core")
    if not isinstance(core, Point | LineString | Polygon):
        raise ValueError(f"{where}.core must be a Point, LineString or Polygon, got a {core.geom_type}")
    scaled = shapely.transform(core, lambda points: factor * points)
    shape = Shape(scaled, factor * number(own.get("radius"), f"{where}.radius"))
    off = max(float(abs(shape.signed_distance(*curve.points.T)).max()) for curve in drawn)
    if not shape.core.equals(shape.core.convex_hull) or not off <= ALTERED:
        raise ValueError(
            f"{where} must be its core grown by its radius, got a rim {off:.3g} mm off: it was altered; without the property "
            "core it is read as it is drawn"
        )
    return tuple(rims(shape))
