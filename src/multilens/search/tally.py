"""What the record of a search is made of: how the fresh starts came down, and which of them were polished."""

from dataclasses import dataclass, field

import torch
from torch import Tensor

from multilens.convergence import Convergence


@dataclass
class Tally:
    """Kept while a search goes on.

    Args:
        histories: scores [b, h] at every step, of the fresh starts of each wave.
        polished: which of the starts were polished.
        scores: what came of each of these, in the unit of the score.
    """

    histories: list[Tensor] = field(default_factory=list)
    polished: list[int] = field(default_factory=list)
    scores: list[float] = field(default_factory=list)

    @property
    def convergence(self) -> Convergence | None:
        """How the fresh starts came down, waves of fewer steps filled up with their last; None where there were none."""
        if not self.histories:
            return None
        longest = max(history.shape[1] for history in self.histories)
        rows = [
            torch.cat([history, history[:, -1:].expand(-1, longest - history.shape[1])], dim=-1)
            for history in self.histories
        ]
        return Convergence(tuple(range(longest)), torch.cat(rows), tuple(self.polished), tuple(self.scores))
