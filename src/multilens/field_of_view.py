"""A field: how far from straight ahead depth is asked for, and which lenses see how much of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan, degrees, isfinite, radians, sqrt, tan

from multilens.lens import Lens


@dataclass(frozen=True)
class Part:
    """A part of a field that the same lenses see.

    Args:
        lenses: index of each of them, from 0, ascending; empty where none sees.
        share: of the field, by weight, > 0 and <= 1.
    """

    lenses: tuple[int, ...]
    share: float


@dataclass(frozen=True)
class Field:
    """Angles from straight ahead at which depth is asked for.

    The lenses look the same way and stand so close together, against the depths, that a point has the same angle for all: which
    of them see it does not depend on the layout. What the baseline takes off the field that two lenses share is the business of
    `PairLimits`.

    Args:
        angles_deg: from the optical axis, degrees, >= 0 and < 90, at least one; a lens sees those up to half its field of view.
        weights: how much each angle counts, >= 0, any scale; None counts all alike.

    Raises:
        ValueError: a number is missing or out of its range.

    Reference:
        docs/pairs.md, "Lenses of unequal fields".
    """

    angles_deg: tuple[float, ...]
    weights: tuple[float, ...]

    def __init__(self, angles_deg: Sequence[float], weights: Sequence[float] | None = None) -> None:
        weights = [1.0] * len(angles_deg) if weights is None else weights
        if not angles_deg or not all(0 <= angle < 90 for angle in angles_deg):
            raise ValueError("angles_deg must be at least one number >= 0 and < 90 degrees")
        if len(weights) != len(angles_deg) or not all(isfinite(w) and w >= 0 for w in weights) or not sum(weights):
            raise ValueError(f"weights must be {len(angles_deg)} finite numbers >= 0, not all 0, one for each angle")
        object.__setattr__(self, "angles_deg", tuple(map(float, angles_deg)))
        object.__setattr__(self, "weights", tuple(map(float, weights)))

    @classmethod
    def rings(cls, field_of_view_deg: float, count: int) -> "Field":
        """Make a round field of rings of equal area on a flat image, so that every pixel counts alike.

        The tangent of ring k is that of half the field times sqrt((k + 1/2) / count): the middle of its area.

        Args:
            field_of_view_deg: from side to side, degrees, > 0 and < 180.
            count: how many rings, >= 1.

        Raises:
            ValueError: a number is out of its range.
        """
        if not 0 < field_of_view_deg < 180:
            raise ValueError(f"field_of_view_deg must be > 0 and < 180 degrees, got {field_of_view_deg:g}")
        if not isinstance(count, int) or count < 1:
            raise ValueError(f"count must be a whole number >= 1, got {count}")
        edge = tan(radians(field_of_view_deg / 2))
        return cls([degrees(atan(edge * sqrt((ring + 0.5) / count))) for ring in range(count)])

    def parts(self, lenses: Sequence[Lens]) -> tuple[Part, ...]:
        """Give who sees which share of the field, the inner part first; a lens whose field is unknown sees everything."""
        shares: dict[tuple[int, ...], float] = {}
        whole = sum(self.weights)
        for angle, weight in sorted(zip(self.angles_deg, self.weights, strict=True)):
            if weight:
                seen_by = tuple(index for index, lens in enumerate(lenses) if _sees(lens, angle))
                shares[seen_by] = shares.get(seen_by, 0.0) + weight / whole
        return tuple(Part(seen_by, share) for seen_by, share in shares.items())


def _sees(lens: Lens, angle_deg: float) -> bool:
    return lens.field_of_view_deg is None or 2 * angle_deg <= lens.field_of_view_deg
