"""The worst of all depths."""

from dataclasses import dataclass, field

from jaxtyping import Float
from torch import Tensor

from multilens.metrics.mean import InverseDepth, MeanSquare, Relative


@dataclass(frozen=True)
class WorstCase:
    """The largest error of all depths that have a weight, however large that is: a specification to keep everywhere.

    Args:
        of: what counts as an error: itself (MeanSquare), relative to the depth, or that of the inverse depth.
    """

    of: MeanSquare | Relative | InverseDepth = field(default_factory=MeanSquare)

    @property
    def name(self) -> str:
        """Say whose worst it is."""
        return f"worst {self.of.error}"

    @property
    def unit(self) -> str:
        """Of the largest error."""
        return self.of.unit

    @property
    def score_unit(self) -> str:
        """Of its square."""
        return self.of.score_unit

    @property
    def is_mean(self) -> bool:
        """Say that it is none."""
        return False

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give what the squared error at each depth is multiplied by."""
        return self.of.factor(depths)

    def figure(self, score: float) -> float:
        """Give the largest error."""
        return self.of.figure(score)
