"""A lens: the hardware that is given, and the ranges in which the design may choose."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from multilens.ranges import refuse_unless_positive, refuse_unless_range
from multilens.sensor import Sensor

LONGEST_NAME = 40
"""Letters."""


@dataclass(frozen=True)
class Lens:
    """What is known of a lens before it is placed.

    Args:
        focal_length: f, mm, > 0.
        aperture_radius: least and largest radius A of the entrance pupil, mm, 0 < least <= largest; equal
            ones fix it.
        focus: nearest and farthest in-focus depth, mm, > 0; None lets it focus anywhere in the problem's range of depths.
        clearance: from the rim of the aperture to the rim of the body that may touch nothing, mm, >= 0.
        disparity_noise: smallest shift between two images that the sensor tells apart, mm on the sensor, > 0; 1 gives the
            thesis' scalars.
        blur_noise: smallest change of blur that the sensor tells apart, mm on the sensor, > 0.
        tiers: sensors behind the one aperture, each with a focus of its own (a jumping spider's eye has 4), >= 1.
        position: None for a free lens, (x, y) in mm for a locked one, and None in place of one coordinate for a lens that
            slides along a line.
        field_of_view_deg: angle of the whole cone that the lens sees, from side to side, degrees, > 0 and < 180; None where it
            is unknown, which limits nothing.
        near_focus: nearest depth that the lens can bring into focus, nearer than which no pair under limits measures with it, mm,
            > 0 and no more than the nearest of `focus`; None where it is unknown, which limits nothing.
        sensor: what stands behind the lens; None where it is unknown, which is enough for every cue but the photometric ones.
        name: what people call the lens, such as tele; it makes no lens unlike another. None for none.

    Raises:
        ValueError: a number is out of its range, or the name cannot stand in a table.
    """

    focal_length: float
    aperture_radius: tuple[float, float]
    focus: tuple[float, float] | None = None
    clearance: float = 0.0
    disparity_noise: float = 1.0
    blur_noise: float = 1.0
    tiers: int = 1
    position: tuple[float | None, float | None] | None = None
    field_of_view_deg: float | None = None
    near_focus: float | None = None
    sensor: Sensor | None = None
    name: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        refuse_unless_positive("focal_length", self.focal_length)
        refuse_unless_range("aperture_radius", self.aperture_radius)
        if self.focus is not None:
            refuse_unless_range("focus", self.focus)
        if not isfinite(self.clearance) or self.clearance < 0:
            raise ValueError(f"clearance must be >= 0 mm and finite, got {self.clearance:g}")
        refuse_unless_positive("disparity_noise", self.disparity_noise)
        refuse_unless_positive("blur_noise", self.blur_noise)
        if not isinstance(self.tiers, int) or self.tiers < 1:
            raise ValueError(f"tiers must be a whole number >= 1, got {self.tiers}")
        if self.position is not None and len(self.position) != 2:
            raise ValueError(f"position must be x and y, got {len(self.position)} numbers")
        for name, coordinate in zip("xy", self.position or (), strict=False):
            if coordinate is not None and not isfinite(coordinate):
                raise ValueError(f"{name} of position must be finite, got {coordinate:g}")
        if self.name is not None and not (
            self.name.strip() and self.name.isprintable() and len(self.name) <= LONGEST_NAME
        ):
            raise ValueError(f"name must be a line of at most {LONGEST_NAME} letters, got {self.name!r:.50}")
        self._refuse_unless_limits()

    def _refuse_unless_limits(self) -> None:
        angle, near = self.field_of_view_deg, self.near_focus
        if angle is not None and not 0 < angle < 180:
            raise ValueError(f"field_of_view_deg must be > 0 and < 180 degrees, got {angle:g}")
        if near is not None:
            refuse_unless_positive("near_focus", near)
            if self.focus is not None and self.focus[0] < near:
                raise ValueError(f"near_focus must be <= the nearest focus = {self.focus[0]:g} mm, got {near:g}")

    @classmethod
    def from_f_number(cls, focal_length: float, f_number: tuple[float, float], **others: Any) -> "Lens":
        """Make a lens whose aperture is bounded by f-numbers, A = f / (2 N).

        Args:
            focal_length: f, mm, > 0.
            f_number: least and largest N, 0 < least <= largest.
            **others: everything else that a lens takes.

        Raises:
            ValueError: a number is out of its range.

        Reference:
            Thesis, equation 5.1.
        """
        refuse_unless_positive("focal_length", focal_length)
        refuse_unless_range("f_number", f_number)
        fastest, slowest = f_number
        return cls(focal_length, (focal_length / (2 * slowest), focal_length / (2 * fastest)), **others)

    @property
    def least_body_radius(self) -> float:
        """Radius of the disc that the lens needs even at its smallest aperture, mm."""
        return self.aperture_radius[0] + self.clearance


def telling_names(lenses: Sequence[Lens]) -> tuple[str, ...]:
    """Give the name of each lens, empty for one without; nothing at all where names tell no lens from another."""
    names = tuple(lens.name or "" for lens in lenses)
    return names if len(set(names)) > 1 else ()
