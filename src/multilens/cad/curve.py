"""A closed curve of straight edges and circular arcs, as drawings have it."""

from dataclasses import dataclass
from math import acos, ceil

import numpy as np
from jaxtyping import Float

from multilens.geometry.shape import refuse_wild_coordinates

MOST_POINTS = 10_000
"""Of a curve that is cut into edges, and of what is made of several."""

NOTHING = 1e-9
"""mm; a shorter piece is what rounding leaves of none."""

MOST_BULGE = 1e6
"""Of an arc that is as good as a whole circle."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A ring of pieces, one from each point to the next and from the last back to the first.

    A piece is straight where its bulge is 0, else an arc: the bulge is the tangent of a quarter of its angle, positive where it
    turns from x to y, as in DXF. 1 is half a circle.

    Args:
        points: mm, at least two, none like the one before it.
        bulges: of the piece that begins at each point.
        exact: whether these pieces are the curve; else it was a spline, an ellipse or the like, and these lie along it.

    Raises:
        ValueError: a point, or the middle of an arc, is not finite or beyond a kilometre.
    """

    points: Float[np.ndarray, "m 2"]
    bulges: Float[np.ndarray, " m"]
    exact: bool = True

    def __post_init__(self) -> None:
        refuse_wild_coordinates(self.points)
        if not (np.abs(self.bulges) < MOST_BULGE).all():
            raise ValueError(f"bulge must be finite and less than {MOST_BULGE:g}, got {np.abs(self.bulges).max():g}")
        refuse_wild_coordinates(self.middles)

    @property
    def straight(self) -> bool:
        """Whether all pieces are straight, and the curve was nothing else."""
        return self.exact and not self.bulges.any()

    @property
    def ends(self) -> Float[np.ndarray, "m 2"]:
        """Give the point at which each piece ends, mm."""
        return np.roll(self.points, -1, axis=0)

    @property
    def middles(self) -> Float[np.ndarray, "m 2"]:
        """Give the point in the middle of each piece, on the arc where it is one, mm."""
        chord = self.ends - self.points
        to_right = np.stack([chord[:, 1], -chord[:, 0]], axis=-1)
        return (self.points + self.ends) / 2 + to_right * self.bulges[:, None] / 2

    @property
    def centres(self) -> Float[np.ndarray, "a 2"]:
        """Give the centre of each piece that is an arc, mm."""
        arc = self.bulges != 0
        start, end, bulge = self.points[arc], self.ends[arc], self.bulges[arc, None]
        chord = end - start
        to_left = np.stack([-chord[:, 1], chord[:, 0]], axis=-1)
        return (start + end) / 2 + to_left * (1 - bulge**2) / (4 * bulge)

    @property
    def radii(self) -> Float[np.ndarray, " a"]:
        """Give the radius of each piece that is an arc, mm."""
        arc = self.bulges != 0
        bulge = np.abs(self.bulges[arc])
        return np.hypot(*(self.ends[arc] - self.points[arc]).T) * (1 + bulge**2) / (4 * bulge)

    def cut(self, sagitta: float) -> Float[np.ndarray, "k 2"]:
        """Give the corners of the curve with every arc cut into edges of equal length, their ends on the arc.

        Args:
            sagitta: largest distance of an edge from its arc, mm, > 0.

        Raises:
            ValueError: it takes more than `MOST_POINTS` edges.
        """
        corners, arcs = [], iter(zip(self.centres, self.radii, strict=True))
        for start, bulge in zip(self.points, self.bulges, strict=True):
            corners.append(start[None])
            if bulge != 0:
                centre, radius = next(arcs)
                angle = 4 * np.arctan(bulge)
                # No fewer than eight edges to a circle: of a small one they would be far off in direction.
                step = min(2 * acos(max(1 - sagitta / radius, -1.0)), np.pi / 4)
                count = ceil(abs(angle) / step)
                refuse_too_many(count + sum(map(len, corners)))
                turned = angle * np.arange(1, count) / count
                cosine, sine = np.cos(turned)[:, None], np.sin(turned)[:, None]
                x, y = start - centre
                corners.append(centre + cosine * (x, y) + sine * (-y, x))
        return np.concatenate(corners)


def circle(centre: tuple[float, float], radius: float) -> Curve:
    """Give a circle as two half circles; mm."""
    x, y = centre
    return Curve(np.array([[x - radius, y], [x + radius, y]], dtype=float), np.ones(2))


def tidy(points: Float[np.ndarray, "m 2"], bulges: Float[np.ndarray, " m"], exact: bool = True) -> Curve:
    """Give a curve without its pieces of no length, such as that which closes a ring whose last point is its first.

    Raises:
        ValueError: a point is not finite, or fewer than two are left.
    """
    refuse_wild_coordinates(points)
    kept = (np.abs(np.roll(points, -1, axis=0) - points) > NOTHING).any(axis=-1)
    if kept.sum() < 2:
        raise ValueError(f"curve must have at least 2 points apart, got {kept.sum()}")
    return Curve(points[kept], bulges[kept], exact)


def refuse_too_many(count: int) -> None:
    """Raise a ValueError for more than `MOST_POINTS` edges."""
    if count > MOST_POINTS:
        raise ValueError(f"curve must be at most {MOST_POINTS} edges, got {count}: a larger tolerance needs fewer")
