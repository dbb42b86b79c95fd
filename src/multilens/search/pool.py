"""The best layouts so far: those that the next ones are varied from, and the one that would be claimed."""

from dataclasses import dataclass, field
from math import isnan, nan

import torch
from torch import Tensor

from multilens.certificate import Certificate
from multilens.layout import Layout
from multilens.question import Question
from multilens.search.legalise import legalise

ALIKE = 1e-5
"""Difference of what is minimised below which two layouts count as one."""


@dataclass(frozen=True)
class Candidate:
    """A layout as it would be claimed: rounded, certified, scored (NaN if infeasible)."""

    layout: Layout
    certificate: Certificate
    score: float

    @classmethod
    def of(cls, question: Question, layout: Layout) -> "Candidate":
        """Round, hold to the bounds, certify and score one layout in float64."""
        layout, certificate = legalise(question, layout)
        return cls(layout, certificate, question.score(layout).item() if certificate.feasible else nan)

    def better_than(self, other: "Candidate | None") -> bool:
        """Whether it scores less; among infeasible ones, whether it lacks less."""
        if other is None:
            return True
        if self.certificate.feasible and other.certificate.feasible:
            return self.score < other.score or isnan(other.score)
        if self.certificate.feasible or other.certificate.feasible:
            return self.certificate.feasible
        return self.certificate.tightest.room > other.certificate.tightest.room


@dataclass
class Elite:
    """The best few unlike vectors, best first.

    Args:
        most: how many are kept.
    """

    most: int
    share: Tensor = field(default_factory=lambda: torch.empty(0))
    value: Tensor = field(default_factory=lambda: torch.empty(0))

    def add(self, share: Tensor, value: Tensor) -> None:
        """Add vectors and keep the best unlike ones."""
        if len(self.value):
            share, value = torch.cat([self.share, share]), torch.cat([self.value, value])
        kept: list[int] = []
        for index in value.argsort().tolist():
            if len(kept) == self.most or not value[index].isfinite():
                break
            if not kept or value[index] - value[kept[-1]] > ALIKE:
                kept.append(index)
        self.share, self.value = share[kept], value[kept]
