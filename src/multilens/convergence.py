"""How the starts of a search came down."""

from dataclasses import dataclass

from jaxtyping import Float
from torch import Tensor


@dataclass(frozen=True, eq=False)
class Convergence:
    """How the starts came down.

    Args:
        steps: at which the scores were taken.
        scores: exact score of each start at each of these steps, NaN for a start that had failed.
        polished: index of each start that was polished, best first before the polish.
        polished_scores: its score afterwards, NaN where it did not become feasible.
    """

    steps: tuple[int, ...]
    scores: Float[Tensor, "s h"]
    polished: tuple[int, ...]
    polished_scores: tuple[float, ...]
