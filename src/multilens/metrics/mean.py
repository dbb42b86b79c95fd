"""Means over the depths: of the squared error itself, relative to the depth, or of the inverse depth.

They differ only in what the squared error at a depth counts for: w, w / Z^2 or w / Z^4.
"""

from dataclasses import dataclass
from math import sqrt

import torch
from jaxtyping import Float
from torch import Tensor

MILLIMETRES_IN_A_METRE = 1000.0


@dataclass(frozen=True)
class MeanSquare:
    """Mean of err^2, mm^2: what the thesis minimises. Its root, RMSE, is in mm; far depths, where errors are large, decide it."""

    error = "error"
    name = "RMSE"
    unit = "mm"
    score_unit = "mm^2"
    is_mean = True

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give 1."""
        return torch.ones_like(depths)

    def figure(self, score: float) -> float:
        """Give the root, mm."""
        return sqrt(score)


@dataclass(frozen=True)
class Relative:
    """Mean of (err / Z)^2: an error of 1 % counts alike at every depth. Its root is quoted in %."""

    error = "relative error"
    name = "relative RMSE"
    unit = "%"
    score_unit = "1"
    is_mean = True

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give 1 / Z^2, mm^-2."""
        return depths**-2.0

    def figure(self, score: float) -> float:
        """Give the root, %."""
        return 100 * sqrt(score)


@dataclass(frozen=True)
class InverseDepth:
    """Mean of (err / Z^2)^2, the error of 1/Z: that of a disparity map. Its root is quoted in dioptres, 1/m.

    A pair of lenses has the same error of 1/Z at every depth.
    """

    error = "error of 1/Z"
    name = "RMSE of 1/Z"
    unit = "1/m"
    score_unit = "1/m^2"
    is_mean = True

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give (1000 mm/m / Z^2)^2, mm^-2 m^-2."""
        return (MILLIMETRES_IN_A_METRE / depths**2) ** 2

    def figure(self, score: float) -> float:
        """Give the root, 1/m."""
        return sqrt(score)
