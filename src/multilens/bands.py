"""Which measurement is best over which range of depths, and where the lead changes hands."""

from dataclasses import dataclass, replace

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.cues import Measurement
from multilens.layout import Layout
from multilens.problem import Problem

STEPS_BETWEEN_DEPTHS = 8
"""Into how many parts the space between two depths of a problem is divided to look for a change of the winner."""

TIE = 1e-9
"""Relative difference below which two errors count as equal, so that rounding does not make twins take turns."""

HALVINGS = 60
"""Of the interval that holds a crossing: more than the bits of a double."""


NOTHING = Measurement("none", (), None, "nothing")
"""Stands where every measurement fails."""


@dataclass(frozen=True)
class Band:
    """A range of depths over which one measurement is the best, or every one fails.

    Args:
        near: nearest depth of the band, mm.
        far: farthest depth, mm, where the next band begins; equal to near where a problem has a single depth.
        measurement: the winner, or NOTHING.
    """

    near: float
    far: float
    measurement: Measurement


@dataclass(frozen=True)
class _Lead:
    """From this depth on, measurement `winner` leads."""

    depth: float
    winner: int


def winner_bands(problem: Problem, layout: Layout) -> tuple[Band, ...]:
    """Give who wins at every depth, as bands from near to far that touch each other.

    The lead is looked up at the depths of the problem, at seven places between each two of them and at every in-focus depth;
    where it changes, the depth at which both errors are equal is found by halving. Of equals the first in the problem's
    order wins. A win that begins and ends between two such places, out of focus, is not seen.

    Args:
        problem: what is asked.
        layout: one layout, not a batch.

    Returns:
        At least one band; the first begins at the least depth of the problem and the last ends at the largest.
    """
    depths = dense_depths(problem, layout)
    winner = _leader(_or_nothing(problem, layout, depths))
    changes = (winner[1:] != winner[:-1]).nonzero().squeeze(-1)
    leads = [_Lead(depths[0].item(), int(winner[0]))]
    leads += _crossings(problem, layout, depths[changes], winner[changes], depths[changes + 1], winner[changes + 1])
    ends = [lead.depth for lead in leads[1:]] + [depths[-1].item()]
    bands: list[Band] = []
    for lead, end in zip(leads, ends, strict=True):
        measurement = (*problem.measurements, NOTHING)[lead.winner]
        if bands and (end == lead.depth or bands[-1].measurement == measurement):
            # Two crossings at one depth: the band between them is empty, and its neighbours may be one.
            bands[-1] = replace(bands[-1], far=end)
        else:
            bands.append(Band(lead.depth, end, measurement))
    return tuple(bands)


def dense_depths(problem: Problem, layout: Layout) -> Float[Tensor, " m"]:
    """Give depths to draw a curve through: the problem's own, seven between each two, and the in-focus depths among them.

    Args:
        problem: what is asked.
        layout: one layout, not a batch.

    Returns:
        Depths in ascending order, none twice, mm, float64.
    """
    depths = problem.depths.unique()
    share = torch.arange(STEPS_BETWEEN_DEPTHS, dtype=torch.float64) / STEPS_BETWEEN_DEPTHS
    between = (depths[:-1, None] + depths.diff().unsqueeze(-1) * share).flatten()
    foci = layout.focus.detach().double().flatten()
    inside = foci[(foci > depths[0]) & (foci < depths[-1])]
    return torch.cat([depths, between, inside]).unique()


def errors_at(problem: Problem, layout: Layout, depths: Float[Tensor, " m"]) -> Float[Tensor, "k m"]:
    """Give the error of every measurement at any depths, mm, float64, without a gradient.

    Args:
        problem: whose lenses and cues are taken.
        layout: one layout, not a batch.
        depths: mm, > 0.
    """
    with torch.no_grad():
        exact = layout.to(torch.float64)
        return torch.cat([cue(exact, problem.lenses, depths) for cue in problem.cues], dim=-2)


def _or_nothing(problem: Problem, layout: Layout, depths: Float[Tensor, " m"]) -> Float[Tensor, "_ m"]:
    """Give the errors and below them a row for NOTHING: worse than what measures, better than what fails."""
    errors = errors_at(problem, layout, depths)
    return torch.cat([errors, torch.full_like(errors[:1], torch.finfo(errors.dtype).max / 2)])


def _leader(errors: Float[Tensor, "k m"]) -> Int[Tensor, " m"]:
    least = errors.amin(0)
    return (errors <= least * (1 + TIE)).int().argmax(0)


def _crossings(
    problem: Problem,
    layout: Layout,
    near: Float[Tensor, " c"],
    before: Int[Tensor, " c"],
    far: Float[Tensor, " c"],
    after: Int[Tensor, " c"],
) -> list[_Lead]:
    """Find where the lead changes between each two depths; a third that leads where two cross makes it two crossings."""
    if not len(near):
        return []
    low, high = near, far
    column = torch.arange(len(near))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        errors = _or_nothing(problem, layout, middle)
        still = errors[before, column] <= errors[after, column]
        low, high = low.where(~still, middle), high.where(still, middle)
    errors = _or_nothing(problem, layout, high)
    third = _leader(errors)
    two = torch.minimum(errors[before, column], errors[after, column])
    split = (third != before) & (third != after) & (errors[third, column] < two * (1 - TIE))
    leads: list[_Lead] = []
    for c in range(len(near)):
        if not split[c]:
            leads.append(_Lead(high[c].item(), int(after[c])))
            continue
        middle, who = high[c : c + 1], third[c : c + 1]
        leads += _crossings(problem, layout, near[c : c + 1], before[c : c + 1], middle, who)
        leads += _crossings(problem, layout, middle, who, far[c : c + 1], after[c : c + 1])
    return leads
