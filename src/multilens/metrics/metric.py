"""A metric: which error of all depths counts."""

from typing import Protocol, runtime_checkable

import torch
from jaxtyping import Float
from torch import Tensor


@runtime_checkable
class Metric(Protocol):
    """A way to make one score of the errors at all depths: the mean or the largest of their weighted squares."""

    @property
    def name(self) -> str:
        """What the number that people quote is called."""
        ...

    @property
    def unit(self) -> str:
        """Of that number; the score is in its square, or a fixed part of it."""
        ...

    @property
    def score_unit(self) -> str:
        """Of the score."""
        ...

    @property
    def is_mean(self) -> bool:
        """Whether the score is a sum over the depths, so that closed forms and bounds hold; else it is the largest."""
        ...

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give what the squared error at each depth is multiplied by, beside the weight of the depth."""
        ...

    def figure(self, score: float) -> float:
        """Turn a score into the number that people quote, in `unit`; the root of the score, or a fixed part of it."""
        ...


def in_words(metric: Metric | None, score: float, digits: int = 6) -> str:
    """Say a score as people quote it, such as "RMSE 1.35 mm"; a score of one's own, that has no metric, as it is."""
    if metric is None:
        return f"score {score:.{digits}g}"
    return f"{metric.name} {metric.figure(score):.{digits}g} {metric.unit}"


def as_quoted(
    metric: Metric, errors: Float[Tensor, "*batch z"], depths: Float[Tensor, " z"]
) -> Float[Tensor, "*batch z"]:
    """Give errors of the depth as a metric quotes them, in its unit: figure(1) sqrt(factor(Z)) err.

    A design whose error is the same everywhere has that as its figure, by a mean and by the worst alike.

    Args:
        metric: such as `Relative`, whose unit is %.
        errors: of each depth, mm.
        depths: Z, mm.
    """
    # What nothing measures stays infinite, also where a metric does not count it.
    return torch.where(errors.isinf(), errors, metric.figure(1.0) * metric.factor(depths).sqrt() * errors)
