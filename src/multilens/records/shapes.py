"""Shapes and backs as plain data and back."""

import shapely
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.geometry.base import BaseGeometry

from multilens.back import Back, KeepOut
from multilens.fields import choice, items, number, numbers, record, text, within
from multilens.geometry.shape import Shape, checked_points
from multilens.records.nouns import Record


def shape_record(shape: Shape) -> Record:
    """Give the core's type, its coordinates as GeoJSON nests them, and the radius."""
    core = shape.core
    if isinstance(core, MultiPolygon):
        coordinates = [_rings(part) for part in core.geoms]
    else:
        coordinates = _rings(core) if isinstance(core, Polygon) else _points(core)
    # GeoJSON has a point bare, not in a list.
    bare = coordinates[0] if isinstance(core, Point) else coordinates
    return {"core": core.geom_type, "radius": float(shape.radius), "coordinates": bare}


def read_shape(value: object, name: str) -> Shape:
    """Read what `shape_record` gives."""
    fields = record(value, name, ("core", "radius", "coordinates"))
    kind = choice(fields["core"], f"{name}.core", ("Polygon", "MultiPolygon", "LineString", "Point"))
    radius, place, coordinates = (
        number(fields["radius"], f"{name}.radius"),
        f"{name}.coordinates",
        fields["coordinates"],
    )
    if kind == "MultiPolygon":
        parts = [_read_polygon(part, f"{place}[{index}]") for index, part in enumerate(items(coordinates, place))]
        core: BaseGeometry = MultiPolygon(parts)
    elif kind == "Polygon":
        core = _read_polygon(coordinates, place)
    elif kind == "LineString":
        core = LineString(_read_points(coordinates, place, 2))
    else:
        core = Point(_read_points([coordinates], place, 1)[0])
    with within(name):
        return Shape(core, radius)


def back_record(back: Back) -> Record:
    """Give the outline and the keep-outs."""
    keep_outs = [
        {"name": keep_out.name, "clearance": float(keep_out.clearance), "shape": shape_record(keep_out.shape)}
        for keep_out in back.keep_outs
    ]
    return {"outline": shape_record(back.outline), "keep_outs": keep_outs}


def read_back(value: object, name: str) -> Back:
    """Read what `back_record` gives."""
    fields = record(value, name, ("outline", "keep_outs"))
    outline = read_shape(fields["outline"], f"{name}.outline")
    keep_outs = tuple(
        _read_keep_out(item, f"{name}.keep_outs[{index}]")
        for index, item in enumerate(items(fields["keep_outs"], f"{name}.keep_outs"))
    )
    with within(name):
        return Back(outline, keep_outs)


def _points(geometry: BaseGeometry) -> list[list[float]]:
    return shapely.get_coordinates(geometry).tolist()


def _rings(polygon: Polygon) -> list[list[list[float]]]:
    return [_points(ring) for ring in (polygon.exterior, *polygon.interiors)]


def _read_points(value: object, name: str, least: int) -> list[tuple[float, float]]:
    pairs = [numbers(pair, f"{name}[{index}]", 2) for index, pair in enumerate(items(value, name))]
    if len(pairs) < least:
        raise ValueError(f"{name} must be at least {least} points, got {len(pairs)}")
    points = [(x, y) for x, y in pairs]
    with within(name):
        checked_points(points)
    return points


def _read_polygon(value: object, name: str) -> Polygon:
    rings = [_read_points(ring, f"{name}[{index}]", 3) for index, ring in enumerate(items(value, name))]
    if not rings:
        raise ValueError(f"{name} must be at least one ring, got none")
    return Polygon(rings[0], rings[1:])


def _read_keep_out(value: object, name: str) -> KeepOut:
    fields = record(value, name, ("name", "clearance", "shape"))
    called, clearance = text(fields["name"], f"{name}.name"), number(fields["clearance"], f"{name}.clearance")
    shape = read_shape(fields["shape"], f"{name}.shape")
    with within(name):
        return KeepOut(called, shape, clearance)
