"""Score a layout that is given: no lens is moved, and of what hardware leaves open only the foci are chosen."""

from dataclasses import replace

import torch

from multilens.back import Back
from multilens.certificate import certify
from multilens.design import GIVEN, Design
from multilens.geometry.shape import rectangle
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.question import Question
from multilens.search.solve import solve

STARTS, PATIENCE = 32, 2
"""Of the search for foci alone, which has few unknowns."""


def evaluate(problem: Problem, seed: int = 0) -> Design:
    """Score a device as it is: every lens in its place, apertures as wide as they open, foci fixed or the best.

    A lens whose bounds of focus differ can focus by itself; its foci are then those that serve this problem best, found with
    everything else fixed. A device may break the constraints, which are our guesses where nothing is published: it is scored
    all the same, and the certificate says what it breaks.

    Args:
        problem: what is asked; every lens is locked in both coordinates.
        seed: of the search for foci.

    Returns:
        A design with the status "as given".

    Raises:
        ValueError: the place of a lens is unknown, or apertures overlap where foci are to be found.
    """
    for index in unplaced(problem):
        raise ValueError(f"lens {index + 1} must have a place to be evaluated, got {problem.lenses[index].position}")
    still = [_still(lens, focus) for lens, focus in zip(problem.lenses, problem.focus_range, strict=True)]
    if refocused(problem):
        roomy = replace(problem, back=_roomy(still), lenses=still, gap=0.0)
        found = solve(roomy, starts=STARTS, patience=PATIENCE, seed=seed, proof=0)
        if not found.feasible:
            raise ValueError(f"apertures must not overlap: {found.reason}")
        return as_given(problem, found.layout)
    tiers = max(lens.tiers for lens in still)
    places = [lens.position for lens in still]
    radii, foci = [lens.aperture_radius[0] for lens in still], [[near] * tiers for near, _ in problem.focus_range]
    return as_given(problem, Layout(places, radii, foci))


def as_given(problem: Question, layout: Layout) -> Design:
    """Give a layout that nobody searched for as a design, with its certificate."""
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    return Design(problem, layout, GIVEN, "", certificate)


def unplaced(problem: Problem) -> tuple[int, ...]:
    """Give the index of each lens that has no place of its own, or slides."""
    return tuple(index for index, lens in enumerate(problem.lenses) if None in (lens.position or (None,)))


def widened(problem: Problem) -> tuple[int, ...]:
    """Give the index of each lens whose aperture is a range, of which the widest is taken."""
    radii = enumerate(lens.aperture_radius for lens in problem.lenses)
    return tuple(index for index, (least, largest) in radii if least < largest)


def refocused(problem: Problem) -> tuple[int, ...]:
    """Give the index of each lens that can focus by itself."""
    return tuple(index for index, (near, far) in enumerate(problem.focus_range) if near < far)


def _still(lens: Lens, focus: tuple[float, float]) -> Lens:
    """Give the lens with nothing left to choose but its foci; its body is of no matter to them."""
    widest = lens.aperture_radius[1]
    return replace(lens, aperture_radius=(widest, widest), clearance=0.0, focus=focus)


def _roomy(lenses: list[Lens]) -> Back:
    """Give a back on which the apertures of locked lenses fit wherever they are."""
    places = torch.tensor([lens.position for lens in lenses], dtype=torch.float64)
    margin = 2 * max(lens.aperture_radius[1] for lens in lenses)
    (left, top), (right, bottom) = (places.amin(0) - margin).tolist(), (places.amax(0) + margin).tolist()
    centre = ((left + right) / 2, (top + bottom) / 2)
    return Back(rectangle(right - left, bottom - top, centre))
