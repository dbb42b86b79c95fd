"""The back of a device: where lenses may stand."""

from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from jaxtyping import Float
from shapely import get_coordinates
from shapely.geometry.base import BaseGeometry

from multilens.geometry import shape
from multilens.geometry.shape import LARGEST_COORDINATE, Shape


@dataclass(frozen=True)
class KeepOut:
    """A named place on the back that lenses stay clear of.

    Args:
        name: what stands there: flash, microphone, logo.
        shape: its outline.
        clearance: distance that a lens' body keeps from it, mm, >= 0.
    """

    name: str
    shape: Shape
    clearance: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.clearance <= LARGEST_COORDINATE:
            raise ValueError(
                f"clearance of keep-out {self.name} must be from 0 to {LARGEST_COORDINATE:g} mm, got {self.clearance:g}"
            )


@dataclass(frozen=True)
class Back:
    """An outline and what stands in it, seen from behind: x to the right, y down, millimetres.

    Args:
        outline: a shapely Polygon or MultiPolygon (several parts, holes), or a Shape with round corners.
        keep_outs: places that lenses stay clear of; `keep_out` adds one.

    Raises:
        ValueError: the outline crosses itself, is not finite, is grown from a core that is not convex, or two keep-outs
            share a name.
    """

    outline: Shape
    keep_outs: tuple[KeepOut, ...] = ()

    def __init__(self, outline: Shape | BaseGeometry, keep_outs: tuple[KeepOut, ...] = ()) -> None:
        outline = _as_shape("outline", outline)
        if outline.radius > 0 and not outline.core.equals(outline.core.convex_hull):
            raise ValueError(
                "outline with round corners must have a convex core, got one with a notch, a hole or parts"
            )
        names = [keep_out.name for keep_out in keep_outs]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"keep-outs must have names of their own, got {name} twice")
        object.__setattr__(self, "outline", outline)
        object.__setattr__(self, "keep_outs", tuple(keep_outs))

    @classmethod
    def rectangle(cls, width: float, height: float) -> "Back":
        """Make a rectangular back, its top left corner at the origin; width and height in mm, > 0."""
        return cls(shape.rectangle(width, height))

    @classmethod
    def rounded_rectangle(cls, width: float, height: float, corner: float) -> "Back":
        """Make a rectangular back with round corners, the top left of its bounding box at the origin.

        Args:
            width: mm, > 0.
            height: mm, > 0.
            corner: radius of the corners, mm, from 0 to half the shorter side.
        """
        return cls(shape.rectangle(width, height, corner=corner))

    @classmethod
    def disc(cls, radius: float) -> "Back":
        """Make a round back centred on the origin; radius in mm, > 0."""
        return cls(shape.disc((0.0, 0.0), radius))

    def keep_out(self, name: str, shape: Shape | BaseGeometry, clearance: float = 0.0) -> "Back":
        """Give this back with one more place that lenses stay clear of.

        Args:
            name: what stands there, unlike the others' names.
            shape: its outline, mm, on the back's own axes.
            clearance: distance that a lens' body keeps from it, mm, >= 0.

        Raises:
            ValueError: the name is taken, the shape is not valid or the clearance is negative.
        """
        added = KeepOut(name, _as_shape(f"keep-out {name}", shape), clearance)
        return replace(self, keep_outs=(*self.keep_outs, added))

    def scaled(self, factor: float) -> "Back":
        """Give this back with its outline grown or shrunk about the middle; keep-outs stay where and as large as they are.

        Args:
            factor: of all lengths of the outline, its round corners too, > 0.

        Raises:
            ValueError: the factor is out of its range.
        """
        if not (isfinite(factor) and factor > 0):
            raise ValueError(f"factor must be > 0 and finite, got {factor:g}")
        return replace(self, outline=self.outline.scaled(factor))

    def region(self) -> BaseGeometry:
        """Give where bodies may be as a plain polygon: the outline less each keep-out grown by its clearance; arcs are cut."""
        region = self.outline.polygon()
        for keep_out in self.keep_outs:
            region = region.difference(Shape(keep_out.shape.core, keep_out.shape.radius + keep_out.clearance).polygon())
        return region

    def corners_for(self, body: float) -> Float[np.ndarray, "c 2"]:
        """Give the corners of the convex hull of all places for a body's centre, mm; arcs are cut, none where it does not fit.

        Args:
            body: radius, mm, >= 0.
        """
        return get_coordinates(self.region().buffer(-body).convex_hull)

    @property
    def size(self) -> float:
        """Diagonal of the bounding box, mm: the scale of everything on this back."""
        left, top, right, bottom = self.outline.bounds
        return ((right - left) ** 2 + (bottom - top) ** 2) ** 0.5


def _as_shape(name: str, given: Shape | BaseGeometry) -> Shape:
    try:
        return given if isinstance(given, Shape) else Shape(given)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
