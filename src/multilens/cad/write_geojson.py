"""A plan as GeoJSON, in millimetres, y upwards: a feature for everything drawn."""

import json
from typing import Any

from shapely import LineString, Point, Polygon
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from multilens.cad.layers import APERTURES, BASELINES, BODIES, KEEP_OUTS, OUTLINE
from multilens.cad.plan import Plan, Stand
from multilens.cad.rims import is_round, rims, straight
from multilens.geometry.shape import Shape

SAGITTA = 1e-3
"""mm; within it circles and round corners are cut into edges, their ends on the arc: GeoJSON has no arcs."""


def write_geojson(plan: Plan) -> str:
    """Give a FeatureCollection. What is round is cut into edges, and its properties `core` and `radius` say it exactly."""
    plan = plan.turned()
    features = [_region(plan.back.outline, {"layer": OUTLINE, "name": "outline"})]
    for keep_out in plan.back.keep_outs:
        facts = {"layer": KEEP_OUTS, "name": keep_out.name, "clearance": float(keep_out.clearance)}
        features.append(_region(keep_out.shape, facts))
    for layer in (APERTURES, BODIES):
        features += [_disc(layer, stand) for stand in plan.stands]
    for a, b, length in plan.baselines:
        line = LineString([(a.x, a.y), (b.x, b.y)])
        features.append(_feature(line, {"layer": BASELINES, "name": f"{a.name} to {b.name}", "length": length}))
    # RFC 7946 has degrees; the units are a foreign member, which it allows.
    head = '{"type": "FeatureCollection", "units": "mm", "axes": "x to the right and y upwards, seen from behind", "features": [\n'
    return head + ",\n".join(json.dumps(feature, allow_nan=False) for feature in features) + "\n]}\n"


def _disc(layer: str, stand: Stand) -> dict[str, Any]:
    facts: dict[str, Any] = {"layer": layer, "name": stand.name}
    if layer == APERTURES:
        facts |= {"focal_length": stand.focal_length, "f_number": stand.f_number, "focus": list(stand.foci)}
    radius = stand.aperture_radius if layer == APERTURES else stand.body_radius
    return _region(Shape(Point(stand.x, stand.y), radius), facts)


def _region(shape: Shape, facts: dict[str, Any]) -> dict[str, Any]:
    if not is_round(shape):
        return _feature(straight(shape), facts)
    (curve,) = rims(shape)
    return _feature(Polygon(curve.cut(SAGITTA)), facts | {"core": mapping(shape.core), "radius": float(shape.radius)})


def _feature(geometry: BaseGeometry, facts: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": facts, "geometry": mapping(geometry)}
