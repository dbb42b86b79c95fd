"""Which share of the field and of the depths is measured by what."""

from dataclasses import dataclass
from math import inf

import torch

from multilens.bands import NOTHING
from multilens.cues import Measurement
from multilens.layout import Layout
from multilens.problem import Problem

MOST_TOLD = 6
"""Measurements whose share is told in words."""


@dataclass(frozen=True)
class Cover:
    """How much one measurement covers.

    Args:
        measurement: the best one there, or NOTHING.
        share: of the field and of the depths, by weight, > 0 and <= 1.
    """

    measurement: Measurement
    share: float


def coverage(problem: Problem, layout: Layout) -> tuple[Cover, ...]:
    """Give what measures best over which share of the field and the depths, the largest share first; of equals the first counts.

    Straight ahead every lens sees; where no field is asked for that is all there is.

    Args:
        problem: what is asked.
        layout: one layout, not a batch.

    Returns:
        Shares that sum to 1, those of 0 left out.
    """
    shares = torch.zeros(len(problem.measurements) + 1, dtype=problem.weights.dtype)
    with torch.no_grad():
        errors = problem.errors(layout.to(torch.float64))
    for part in problem.parts:
        blind = torch.tensor([not set(m.lenses) <= set(part.lenses) for m in problem.measurements], dtype=torch.bool)
        least, best = errors.masked_fill(blind.unsqueeze(-1), inf).min(0)
        best = best.where(least.isfinite(), len(problem.measurements))
        shares.index_add_(0, best, part.share * problem.weights)
    every = zip((*problem.measurements, NOTHING), shares.tolist(), strict=True)
    covers = [Cover(measurement, share) for measurement, share in every if share > 0]
    return tuple(sorted(covers, key=lambda cover: -cover.share))


def coverage_in_words(problem: Problem, layout: Layout) -> str:
    """Say what measures best over which share, in one line: the largest shares, and how many there are beside them."""
    covers = coverage(problem, layout)
    words = [f"{cover.measurement.label} {100 * cover.share:.3g} %" for cover in covers[:MOST_TOLD]]
    more = len(covers) - MOST_TOLD
    return ", ".join([*words, f"{more} more"] if more > 0 else words)
