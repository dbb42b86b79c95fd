"""The question: what a search needs to know, whoever asks."""

from collections.abc import Sequence
from math import isfinite
from typing import Protocol, runtime_checkable

from jaxtyping import Float
from torch import Tensor

from multilens.back import Back
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.metrics import Metric


@runtime_checkable
class Question(Protocol):
    """What the search needs to know: the constraints, what it minimises, and what may be claimed of the outcome."""

    @property
    def back(self) -> Back:
        """Where lenses may stand."""
        ...

    @property
    def lenses(self) -> tuple[Lens, ...]:
        """What is known of each lens."""
        ...

    @property
    def gap(self) -> float:
        """Distance that bodies keep from each other, mm."""
        ...

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm."""
        ...

    @property
    def metric(self) -> Metric | None:
        """How the score reads; None for a score of one's own, in a unit of its own."""
        ...

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give the numbers of which the largest is minimised, differentiable by autograd; smooth where the score jumps."""
        ...

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the score that may be claimed: exact, whatever the terms of a search make of it."""
        ...


def refuse_unless_lenses_and_gap(lenses: Sequence[Lens], gap: float) -> None:
    """Refuse no lenses at all, and a gap that is not a distance.

    Raises:
        ValueError: one of the two is so.
    """
    if not lenses:
        raise ValueError("lenses must be at least one, got none")
    if not isfinite(gap) or gap < 0:
        raise ValueError(f"gap must be >= 0 mm and finite, got {gap:g}")
