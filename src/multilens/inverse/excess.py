"""Tolerances as a metric: how many times what is allowed the largest error is."""

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from jaxtyping import Float
from torch import Tensor

from multilens.tolerance import Tolerance
from multilens.working_range import allowed_error


@dataclass(frozen=True)
class Excess:
    """The largest of all errors over what is allowed at their depth: 1 or less where a tolerance is kept everywhere.

    Args:
        tolerance: what is allowed.
    """

    tolerance: Tolerance
    name: ClassVar[str] = "largest error / tolerance"
    unit: ClassVar[str] = "1"
    score_unit: ClassVar[str] = "1"
    is_mean: ClassVar[bool] = False

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give one over the square of what is allowed, mm^-2."""
        return allowed_error(self.tolerance, depths) ** -2

    def figure(self, score: float) -> float:
        """Give the root: how many times what is allowed."""
        return sqrt(score)
