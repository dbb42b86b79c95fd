"""What a configuration may hold of the score: which error counts, of one measurement or all, and how much each depth counts."""

from dataclasses import dataclass, field
from enum import Enum

from omegaconf import MISSING

MetricName = Enum("MetricName", ["mean_square", "relative", "inverse_depth", "worst_case"])
"""The metrics that a configuration can name."""

ErrorName = Enum("ErrorName", ["mean_square", "relative", "inverse_depth"])
"""Those whose error at one depth the worst case can be taken of."""

FusionName = Enum("FusionName", ["best", "inverse_variance"])
"""The fusions that a configuration can name."""


@dataclass
class MetricConfig:
    """Which error of all depths counts.

    Args:
        name: mean_square, relative, inverse_depth or worst_case.
        of: what counts as an error in the worst case: mean_square, relative or inverse_depth; null for another metric.
    """

    name: MetricName = MISSING
    of: ErrorName | None = None


@dataclass
class FusionConfig:
    """What is made of several measurements of one depth.

    Args:
        name: best or inverse_variance.
        guess: standard deviation of what is known of a depth before it is measured, mm; null for nothing, or for the spread of
            the depths where a cue may fail.
    """

    name: FusionName = MISSING
    guess: float | None = None


@dataclass
class HistogramConfig:
    """How much the depths of each bin count together; within a bin they count alike.

    Args:
        edges: of the bins, mm, ascending, from near to far.
        shares: of each bin, >= 0, in any unit; one fewer than edges.
    """

    edges: list[float] = field(default_factory=list)
    shares: list[float] = field(default_factory=list)
