"""A shape with exact round corners: a core of straight edges, grown by a radius."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from math import pi

import numpy as np
import shapely
from jaxtyping import Float
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.affinity import scale
from shapely.geometry.base import BaseGeometry

from multilens.geometry.nearest import distance_to_nearest

LARGEST_COORDINATE = 1e6
"""mm; a kilometre is no longer the back of a device, and squares of larger numbers lose the micrometre."""


@dataclass(frozen=True)
class Shape:
    """All points within `radius` of `core` (a Minkowski sum with a disc).

    A polygon is a core of radius 0, a disc a point grown by its radius, a rounded rectangle a smaller rectangle grown by its
    corner. No arc is ever cut into edges: distances to a shape are exact.

    Args:
        core: Polygon, MultiPolygon, LineString or Point; coordinates in mm, finite, valid. Rings may be open or closed,
            run either way and repeat points; they are stored in one tidy form.
        radius: mm, >= 0; > 0 for a core without area.

    Raises:
        ValueError: the core is empty, not finite, crosses itself, has a hole outside its shell, or is of another type; the
            radius is negative. What shapely finds invalid is named with its place.
    """

    core: BaseGeometry
    radius: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.core, Polygon | MultiPolygon | LineString | Point):
            raise ValueError(f"shape must be a polygon, line or point, got {type(self.core).__name__}")
        if not 0 <= self.radius <= LARGEST_COORDINATE:
            raise ValueError(f"radius must be from 0 to {LARGEST_COORDINATE:g} mm, got {self.radius:g}")
        if self.core.is_empty:
            raise ValueError("shape must hold at least one point, got an empty one")
        refuse_wild_coordinates(shapely.get_coordinates(self.core))
        if not self.core.is_valid:
            raise ValueError(
                f"shape must not cross itself or have a hole outside, got {shapely.is_valid_reason(self.core)}"
            )
        if self.radius == 0 and self.core.area == 0:
            raise ValueError(f"shape must have an area, got a {self.core.geom_type} of radius 0 mm")
        object.__setattr__(self, "core", shapely.remove_repeated_points(self.core).normalize())

    @cached_property
    def segments(self) -> Float[np.ndarray, "e 2 2"]:
        """Give the straight edges of the core, start and end point of each, mm, as closed rings.

        A line is a ring that runs there and back, a point one edge of length 0: rings that enclose nothing.
        """
        if isinstance(self.core, Point):
            return np.repeat(shapely.get_coordinates(self.core)[None], 2, axis=1)
        if isinstance(self.core, LineString):
            there = shapely.get_coordinates(self.core)
            rings = [np.concatenate([there, there[-2::-1]])]
        else:
            rings = [shapely.get_coordinates(ring) for ring in shapely.get_parts(self.core.boundary)]
        return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])

    def polygon(self, segments_per_quarter: int = 64) -> Polygon | MultiPolygon:
        """Give the shape as a plain polygon, its arcs cut into edges with their ends on the arc: to draw, and to measure areas."""
        grown = self.core if self.radius == 0 else self.core.buffer(self.radius, quad_segs=segments_per_quarter)
        assert isinstance(grown, Polygon | MultiPolygon)
        return grown

    def signed_distance(self, x: Float[np.ndarray, "*m"], y: Float[np.ndarray, "*m"]) -> Float[np.ndarray, "*m"]:
        """Give the distance of many points to the rim, mm, negative inside; many edges cost little more than few.

        As `multilens.geometry.distance.signed_distance` does, without a gradient.
        """
        points = np.stack([x.ravel(), y.ravel()], axis=-1).astype(np.float64, copy=False)
        distance = distance_to_nearest(points, self.segments).reshape(x.shape)
        if self.core.area > 0:
            shapely.prepare(self.core)
            distance = np.where(shapely.contains_xy(self.core, x, y), -distance, distance)
        return distance - self.radius

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, least y, largest x and largest y, mm, exact."""
        left, top, right, bottom = self.core.bounds
        return left - self.radius, top - self.radius, right + self.radius, bottom + self.radius

    @cached_property
    def area(self) -> float:
        """Area, mm^2.

        Exact where the core is convex, by Steiner's formula, area + perimeter radius + pi radius^2, or the radius 0;
        elsewhere to 1e-6 of it, with arcs cut into edges.
        """
        if self.radius > 0 and self.core.convex_hull.area > self.core.area:
            return self.polygon(segments_per_quarter=1024).area
        start, end = np.moveaxis(self.segments, 1, 0)
        perimeter = np.hypot(*(end - start).T).sum().item()
        return self.core.area + perimeter * self.radius + pi * self.radius**2

    @property
    def middle(self) -> tuple[float, float]:
        """Give x and y of the middle of the bounding box, mm."""
        left, top, right, bottom = self.bounds
        return (left + right) / 2, (top + bottom) / 2

    def scaled(self, factor: float) -> "Shape":
        """Give the shape grown or shrunk about its middle, round corners too; factor > 0."""
        return Shape(scale(self.core, factor, factor, origin=self.middle), self.radius * factor)

    @property
    def holds_its_shrunken_self(self) -> bool:
        """Whether the shape shrunk about its middle lies within it, by any factor: the middle sees every point of it.

        The rings of the core then run around the middle all one way, up to a billionth of the shape's size.
        """
        start, end = np.moveaxis(self.segments - np.asarray(self.middle), 1, 0)
        turn = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
        slack = 1e-9 * np.abs(self.segments - np.asarray(self.middle)).max() ** 2
        return bool((turn >= -slack).all() or (turn <= slack).all())


def refuse_wild_coordinates(coordinates: Float[np.ndarray, "m 2"]) -> None:
    """Raise a ValueError that names the first point that is not finite or lies beyond a kilometre."""
    wild = np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(-1))
    if len(wild):
        x, y = coordinates[wild[0]]
        raise ValueError(
            f"point {wild[0]} must be finite and within {LARGEST_COORDINATE:g} mm of the origin, got ({x:g}, {y:g})"
        )


def disc(centre: tuple[float, float], radius: float) -> Shape:
    """Make a disc.

    Args:
        centre: x and y, mm.
        radius: mm, > 0.
    """
    return Shape(Point(checked_points([centre])[0]), radius)


def rectangle(width: float, height: float, centre: tuple[float, float] | None = None, corner: float = 0.0) -> Shape:
    """Make a rectangle with round corners.

    Args:
        width: along x, mm, > 0.
        height: along y, mm, > 0.
        centre: mm; None puts the corner of least x and y at the origin.
        corner: radius of the corners, mm, from 0 to half the shorter side.

    Raises:
        ValueError: a length is out of its range.
    """
    for name, length in (("width", width), ("height", height)):
        if not 0 < length <= LARGEST_COORDINATE:
            raise ValueError(f"{name} must be > 0 and at most {LARGEST_COORDINATE:g} mm, got {length:g}")
    if not 0 <= corner <= min(width, height) / 2:
        raise ValueError(
            f"corner must be from 0 to half the shorter side, {min(width, height) / 2:g} mm, got {corner:g}"
        )
    x, y = checked_points([centre or (width / 2, height / 2)])[0]
    left, right = _ends(x, width, corner)
    top, bottom = _ends(y, height, corner)
    if left == right and top == bottom:
        return Shape(Point(left, top), corner)
    if left == right or top == bottom:
        return Shape(LineString([(left, top), (right, bottom)]), corner)
    return Shape(shapely.box(left, top, right, bottom), corner)


def _ends(middle: float, length: float, less: float) -> tuple[float, float]:
    """Give both ends of a length, shortened by `less` at each, as the decimals in which they were written would have them."""
    centre, half = Decimal(repr(float(middle))), Decimal(repr(float(length))) / 2 - Decimal(repr(float(less)))
    return float(centre - half), float(centre + half)


def polygon(points: list[tuple[float, float]], holes: Sequence[list[tuple[float, float]]] = ()) -> Shape:
    """Make a polygon from its corners, in order, the ring open or closed.

    Args:
        points: at least three, mm, finite.
        holes: corners of each hole, likewise; a hole lies within the polygon.

    Raises:
        ValueError: fewer than three points, one not finite, edges that cross (the crossing is named), or a hole outside.
    """
    if len(points) < 3:
        raise ValueError(f"polygon must have at least 3 points, got {len(points)}")
    for hole in holes:
        if len(hole) < 3:
            raise ValueError(f"hole must have at least 3 points, got {len(hole)}")
    return Shape(Polygon(checked_points(points), [checked_points(hole) for hole in holes]))


def checked_points(points: list[tuple[float, float]]) -> Float[np.ndarray, "m 2"]:
    """Give points as an array, refused before any library sees them if they are not finite pairs of numbers."""
    for index, point in enumerate(points):
        if len(point) != 2:
            raise ValueError(f"point {index} must be x and y, got {len(point)} numbers")
    coordinates = np.asarray(points, dtype=np.float64)
    refuse_wild_coordinates(coordinates)
    return coordinates
