"""How much room there is on a back, rounded up: for one body, for all of them, and between two centres."""

from dataclasses import dataclass
from math import cos, inf, pi

import numpy as np
from jaxtyping import Float

from multilens.back import Back
from multilens.constraints import room_at

DIRECTIONS = 256
"""In which widths are measured; what lies between two of them is covered by a factor 1 / cos(pi / DIRECTIONS)."""

MOST_EDGES = 24
"""Of a convex hull whose every two edges are looked at; one of more edges is enclosed by as many lines."""

SAFE = 1e-9
"""Part of the back's size by which lengths are rounded up, far beyond what floats lose."""

GRID = 160
"""Squares along the longer side of a back that is not convex."""

FINEST = 1e-4
"""Part of the back's size to which the largest body that fits is found."""

ARC = 2e-4
"""Part of the square of the back's size by which its area is taken larger: cutting arcs into edges takes off less."""


def largest_body(back: Back) -> float:
    """Give no less than the radius of the largest disc that fits on the back, mm; negative where keep-outs cover it.

    A point's room changes no faster than one moves, so a square holds no more than its centre and half its diagonal. Squares are
    quartered while they may hold more than the best centre found.
    """
    left, top, right, bottom = back.outline.bounds
    half = max(right - left, bottom - top) / 2
    x, y = np.array([(left + right) / 2]), np.array([(top + bottom) / 2])
    found, most = -inf, inf
    while most > found + FINEST * back.size and len(x) < 50_000:
        half /= 2
        step = np.array([-half, half, -half, half]), np.array([-half, -half, half, half])
        x, y = (x[:, None] + step[0]).ravel(), (y[:, None] + step[1]).ravel()
        room = room_at(back, x, y)
        found = max(found, float(room.max()))
        reach = room + half * 2**0.5
        most = float(reach.max())
        x, y = x[reach > found], y[reach > found]
    # A disc is no wider than the hull in any direction; on plain shapes this is exact.
    _, support = _supports(back)
    narrowest = float((support + np.roll(support, DIRECTIONS // 2)).min()) / 2
    return min(most, narrowest) + SAFE * back.size


def body_area(back: Back, gap: float) -> float:
    """Give no less than the area that bodies, each grown by half the gap, can cover together, mm^2.

    A region with the area S, the rim L and p parts has, grown by t, an area of S + L t + p pi t^2 at most (Steiner).
    """
    region = back.region()
    parts = len(getattr(region, "geoms", [region]))
    grown = region.area + region.length * (1 + ARC) * gap / 2 + parts * pi * (gap / 2) ** 2
    return grown + ARC * back.size**2


def box_area(back: Back, gap: float) -> float:
    """Give the area of the back's bounding box grown by half the gap on every side, mm^2: boxes side by side fill the plane."""
    left, top, right, bottom = back.outline.bounds
    return (right - left + gap) * (bottom - top + gap) * (1 + SAFE)


@dataclass(frozen=True, eq=False)
class Reach:
    """How far to each side the centre of a body can stand, for bodies of several radii.

    Args:
        support: the largest coordinate of a centre in each direction, from the middle of the back, mm, no less than it is.
    """

    support: Float[np.ndarray, "r u"]

    @classmethod
    def free(cls, back: Back, radii: Float[np.ndarray, " r"]) -> "Reach":
        """Give the reach of bodies that may stand anywhere.

        A body of radius r within lines n . x <= c has its centre within n . x <= c - r. A direction u = p n + q m, p, q >= 0, then
        has no coordinate above p (c_n - r) + q (c_m - r). The least over all lines and pairs of lines counts. Where the back has
        a notch, parts or keep-outs, squares of a grid that may hold a centre are looked at too.
        """
        directions, support = _supports(back)
        normal, offset = _lines(back)
        first, second = np.triu_indices(len(normal), 1)
        cross = normal[first, 0] * normal[second, 1] - normal[first, 1] * normal[second, 0]
        apart = np.abs(cross) > 1e-6
        first, second, cross = first[apart], second[apart], cross[apart]
        p = (np.outer(directions[:, 0], normal[second, 1]) - np.outer(directions[:, 1], normal[second, 0])) / cross
        q = (np.outer(directions[:, 1], normal[first, 0]) - np.outer(directions[:, 0], normal[first, 1])) / cross
        # Rounding must not lose an edge's own direction; a factor below 0 by so little changes nothing that SAFE does not cover.
        between = (p > -1e-12) & (q > -1e-12)
        height = np.where(between, p * offset[first] + q * offset[second], inf)
        shrinking = np.where(between, p + q, 0.0)
        reach = np.stack(
            [np.minimum(support - radius, (height - shrinking * radius).min(1, initial=inf)) for radius in radii]
        )
        if back.keep_outs or not back.outline.core.equals(back.outline.core.convex_hull):
            reach = np.minimum(reach, _reach_on_grid(back, radii))
        return cls(reach + SAFE * back.size)

    @classmethod
    def locked(cls, back: Back, place: tuple[float, float], radii: Float[np.ndarray, " r"]) -> "Reach":
        """Give the reach of a body that stands in one place, mm, whatever its radius."""
        support = (np.asarray(place) - _middle(back)) @ _directions().T
        return cls(np.repeat(support[None], len(radii), axis=0) + SAFE * back.size)


def most_apart(first: Float[np.ndarray, "m u"], second: Float[np.ndarray, "m u"]) -> Float[np.ndarray, " m"]:
    """Give no less than the distance that two centres can have, mm, from the reach of either in every direction."""
    apart = (first + np.roll(second, DIRECTIONS // 2, axis=1)).max(1)
    return np.maximum(apart, 0.0) / cos(pi / DIRECTIONS)


def _reach_on_grid(back: Back, radii: Float[np.ndarray, " r"]) -> Float[np.ndarray, "r u"]:
    """Give the largest coordinate of a square that may hold a centre, in each direction; minus infinity where none may."""
    left, top, right, bottom = back.outline.bounds
    half = max(right - left, bottom - top) / GRID / 2
    x, y = np.meshgrid(np.arange(left + half, right + half, 2 * half), np.arange(top + half, bottom + half, 2 * half))
    reach = half * 2**0.5
    # Room changes no faster than one moves.
    room = room_at(back, x.ravel(), y.ravel()) + reach + SAFE * back.size
    most_room_first = np.argsort(-room, kind="stable")
    most_room_first = most_room_first[room[most_room_first] >= radii.min()]
    places = np.stack([x.ravel(), y.ravel()], axis=1)[most_room_first] - _middle(back)
    enough = np.searchsorted(-room[most_room_first], -radii, side="right")
    found = np.full((len(radii), DIRECTIONS), -inf)
    if len(places):
        for index, direction in enumerate(_directions()):
            farthest = np.maximum.accumulate(places @ direction) + reach
            found[:, index] = np.where(enough > 0, farthest[np.maximum(enough - 1, 0)], -inf)
    return found


def _directions() -> Float[np.ndarray, "u 2"]:
    angle = np.arange(DIRECTIONS) * (2 * pi / DIRECTIONS)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _middle(back: Back) -> Float[np.ndarray, " 2"]:
    left, top, right, bottom = back.outline.bounds
    return np.array([(left + right) / 2, (top + bottom) / 2])


def _supports(back: Back) -> tuple[Float[np.ndarray, "u 2"], Float[np.ndarray, " u"]]:
    """Give directions and how far the back reaches in each, from its middle, mm."""
    directions = _directions()
    corners = back.outline.segments[:, 0] - _middle(back)
    return directions, (corners @ directions.T).max(0) + back.outline.radius


def _lines(back: Back) -> tuple[Float[np.ndarray, "l 2"], Float[np.ndarray, " l"]]:
    """Give lines around the back, its hull's edges or evenly turned: outward normals and offsets from its middle, mm."""
    rim = back.outline.core.convex_hull.boundary
    ring = np.asarray(rim.coords) if back.outline.core.area > 0 else np.zeros((0, 2))
    if 0 < len(ring) - 1 <= MOST_EDGES:
        edge = np.diff(ring, axis=0)
        # Which way a ring runs does not matter: a line on either side of the back holds it.
        normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1) / np.linalg.norm(edge, axis=1, keepdims=True)
        normal = np.concatenate([normal, -normal])
    else:
        normal = _directions()[:: DIRECTIONS // MOST_EDGES]
    corners = back.outline.segments[:, 0] - _middle(back)
    return normal, (corners @ normal.T).max(0) + back.outline.radius
