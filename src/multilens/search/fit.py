"""Questions that no layout can answer, seen before any search."""

from itertools import combinations
from math import dist, pi

import torch
from shapely import maximum_inscribed_circle

from multilens.constraints import ExactRoom
from multilens.problem import Question

ARC = 1e-4
"""Part of the back's diagonal by which its region is taken larger: cutting arcs into edges takes off less."""


def why_nothing_fits(question: Question) -> str | None:
    """Give the reason why no layout can be feasible, or None where none was found, which proves nothing.

    Looked at are each lens by itself (the largest disc that the outline can hold), the sum of the bodies' areas, and locked
    lenses against their surroundings and each other.
    """
    bodies = [lens.least_body_radius for lens in question.lenses]
    # Arcs cut into 64 edges a quarter lose less than ARC of their radius; grown by that, the region is none too small.
    region = question.back.region().buffer(question.back.size * ARC)
    if region.is_empty:
        return "the keep-outs cover the whole back"
    tolerance = question.back.size * ARC
    widest = maximum_inscribed_circle(region, tolerance).length + tolerance
    for index, body in enumerate(bodies):
        if body > widest:
            return (
                f"lens {index + 1} needs a disc of radius {body:.4g} mm (smallest aperture and clearance), "
                f"the largest that fits on the back has {widest:.4g} mm"
            )
    need = sum(pi * body**2 for body in bodies)
    if need > region.area:
        return f"the {len(bodies)} bodies need {need:.4g} mm^2 at their smallest apertures, the back has {region.area:.4g} mm^2"
    return _locked_in_conflict(question, bodies)


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
