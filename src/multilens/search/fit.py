"""Questions that no layout can answer, seen before any search."""

from itertools import combinations
from math import dist, pi

import numpy as np
import torch
from shapely import maximum_inscribed_circle

from multilens.back import Back
from multilens.constraints import ExactRoom, room_at
from multilens.question import Question

ARC = 1e-4
"""Part of the back's diagonal by which its region is taken larger: cutting arcs into edges takes off less."""

LOOKS = 16
"""Places along each side of the back's bounding box that are looked at before its largest disc is sought."""


def why_nothing_fits(question: Question) -> str | None:
    """Give the reason why no layout can be feasible, or None where none was found, which proves nothing.

    Looked at are each lens by itself (the largest disc that the outline can hold), the sum of the bodies' areas, and locked
    lenses against their surroundings and each other.
    """
    bodies = [lens.least_body_radius for lens in question.lenses]
    reason = None if _plainly_spacious(question.back, bodies) else _too_large(question.back, bodies)
    return reason or _locked_in_conflict(question, bodies)


def _plainly_spacious(back: Back, bodies: list[float]) -> bool:
    """Whether a few looks show that every body fits by itself and that there is area for all; if not, nothing is known."""
    left, top, right, bottom = back.outline.bounds
    share = (np.arange(LOOKS) + 0.5) / LOOKS
    x, y = np.meshgrid(left + share * (right - left), top + share * (bottom - top))
    # No more than the area there is: arcs are cut inside, and a keep-out takes no more than its bounding box.
    area = back.outline.polygon().area
    for keep_out in back.keep_outs:
        left, top, right, bottom = keep_out.shape.bounds
        area -= (right - left + 2 * keep_out.clearance) * (bottom - top + 2 * keep_out.clearance)
    return _need(bodies) <= area and max(bodies) <= room_at(back, x, y).max().item()


def _too_large(back: Back, bodies: list[float]) -> str | None:
    # Arcs cut into 64 edges a quarter lose less than ARC of their radius; grown by that, the region is none too small.
    tolerance = back.size * ARC
    region = back.region().buffer(tolerance)
    if region.is_empty:
        return "the keep-outs cover the whole back"
    widest = maximum_inscribed_circle(region, tolerance).length + tolerance
    for index, body in enumerate(bodies):
        if body > widest:
            return (
                f"lens {index + 1} needs a disc of radius {body:.4g} mm (smallest aperture and clearance), "
                f"the largest that fits on the back has {widest:.4g} mm"
            )
    need = _need(bodies)
    if need > region.area:
        return f"the {len(bodies)} bodies need {need:.4g} mm^2 at their smallest apertures, the back has {region.area:.4g} mm^2"
    return None


def _need(bodies: list[float]) -> float:
    return sum(pi * body**2 for body in bodies)


def _locked_in_conflict(question: Question, bodies: list[float]) -> str | None:
    locked = {
        index: (x, y)
        for index, lens in enumerate(question.lenses)
        for x, y in [lens.position or (None, None)]
        if x is not None and y is not None
    }
    for index, place in locked.items():
        room = ExactRoom(question.back)(torch.tensor([place], dtype=torch.float64)).min().item()
        if bodies[index] > room * (1 + 1e-12):
            return f"lens {index + 1} is locked where {room:.4g} mm are free around it and needs {bodies[index]:.4g} mm"
    for i, j in combinations(locked, 2):
        apart, need = dist(locked[i], locked[j]), bodies[i] + bodies[j] + question.gap
        if need > apart * (1 + 1e-12):
            return f"lenses {i + 1} and {j + 1} are locked {apart:.4g} mm apart and need {need:.4g} mm"
    return None
