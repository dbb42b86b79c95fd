"""What is handed over of a design: its back, and where its lenses stand."""

from dataclasses import dataclass, replace
from itertools import combinations
from math import hypot

from shapely.affinity import scale

from multilens.back import Back
from multilens.constraints import body_radius
from multilens.design import Design
from multilens.geometry.shape import Shape


@dataclass(frozen=True)
class Stand:
    """A lens where it stands; lengths in mm.

    Args:
        number: of the lens, from 1.
        x: of its centre.
        y: of its centre.
        aperture_radius: of the entrance pupil.
        body_radius: of the disc that it needs for itself.
        focal_length: f.
        f_number: N.
        foci: in-focus depth of each tier.
        called: what people call it; empty for nothing.
    """

    number: int
    x: float
    y: float
    aperture_radius: float
    body_radius: float
    focal_length: float
    f_number: float
    foci: tuple[float, ...]
    called: str = ""

    @property
    def name(self) -> str:
        """Give its number, and what it is called."""
        return f"lens {self.number} ({self.called})" if self.called else f"lens {self.number}"


@dataclass(frozen=True)
class Plan:
    """A back and the lenses on it.

    Args:
        back: as designs have it, y downwards, unless it was turned.
        stands: of the lenses; none for a back alone.
    """

    back: Back
    stands: tuple[Stand, ...] = ()

    @property
    def baselines(self) -> tuple[tuple[Stand, Stand, float], ...]:
        """Give every pair of lenses and its distance, mm."""
        return tuple((a, b, hypot(b.x - a.x, b.y - a.y)) for a, b in combinations(self.stands, 2))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Give left, least y, right and largest y of the back and the lenses, which may stand off it, mm."""
        boxes = [
            (s.x - s.body_radius, s.y - s.body_radius, s.x + s.body_radius, s.y + s.body_radius) for s in self.stands
        ]
        left, low, right, high = zip(self.back.outline.bounds, *boxes, strict=True)
        return min(left), min(low), max(right), max(high)

    def turned(self) -> "Plan":
        """Give the same plan with y upwards: y changes its sign, and what is seen stays as it is."""
        keep_outs = tuple(replace(keep_out, shape=_turned(keep_out.shape)) for keep_out in self.back.keep_outs)
        # Nothing becomes -0.
        stands = tuple(replace(stand, y=0.0 - stand.y) for stand in self.stands)
        return Plan(Back(_turned(self.back.outline), keep_outs), stands)


def plan_of(what: Design | Back) -> Plan:
    """Give what is handed over of a design, or of a back alone.

    Raises:
        ValueError: the design is infeasible: it has no layout.
    """
    if isinstance(what, Back):
        return Plan(what)
    if not what.feasible and what.status != "as given":
        raise ValueError(f"design must have a layout to be exported: {what.reason}")
    layout, lenses = what.layout, what.problem.lenses
    columns = zip(
        layout.position.tolist(),
        layout.aperture_radius.tolist(),
        body_radius(layout, lenses).tolist(),
        [float(lens.focal_length) for lens in lenses],
        what.f_numbers,
        what.foci,
        [lens.name or "" for lens in lenses],
        strict=True,
    )
    return Plan(what.problem.back, tuple(Stand(i, *place, *rest) for i, (place, *rest) in enumerate(columns, 1)))


def _turned(shape: Shape) -> Shape:
    return Shape(scale(shape.core, 1, -1, origin=(0, 0)), shape.radius)
