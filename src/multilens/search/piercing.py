"""The foci of equal apertures with the least worst error, by intervals pierced: where a search for the worst case begins."""

import torch
from jaxtyping import Bool, Float
from torch import Tensor

HALVINGS = 60
"""Of the range of scores, on a logarithmic scale."""

RANGE = 1e-12
"""Part of the largest score there is that is looked for at least."""


class Piercing:
    """Depths that every focus serves up to a distance, and as few foci as serve them all.

    For a score t, the largest squared error times the factor q of its depth, a focus Zf serves Z where abs(Z - Zf) is no more than
    sqrt(t / q) / (slope Z): it lies in an interval around Z. Intervals are pierced by the fewest points where each time the
    least right end of those that are left is taken. The least t for which there are enough foci is found by halving.

    Args:
        depths: mm, in any order.
        weights: q of each; those of 0 do not count.
    """

    def __init__(self, depths: Float[Tensor, " z"], weights: Float[Tensor, " z"]) -> None:
        counted = weights > 0
        self.depth, self.weight = depths[counted], weights[counted]

    def best_foci(self, gain: Float[Tensor, " b"], slope: Float[Tensor, " b"], count: int) -> Float[Tensor, "b count"]:
        """Give the foci that serve the depths best, nearest first.

        Args:
            gain: of stereo, err = gain Z^2, 1/mm; infinite where there is none.
            slope: of defocus, err = slope Z abs(Z - Zf), 1/mm.
            count: how many foci, >= 1.

        Returns:
            mm. Where fewer would do, the others are at the farthest depth.
        """
        largest = (self.weight * self.depth**4).amax()
        # In units of the slope: only the ratio decides.
        ratio = (gain / slope).square().unsqueeze(-1)
        high = largest * torch.ones_like(gain)
        low = RANGE * high
        for _ in range(HALVINGS):
            middle = (low * high).sqrt()
            enough = ~self._pierced(ratio, middle, count)[1].any(-1)
            low, high = low.where(enough, middle), high.where(~enough, middle)
        return self._pierced(ratio, high, count)[0].sort(-1).values

    def _pierced(
        self, ratio: Float[Tensor, "b 1"], score: Float[Tensor, " b"], count: int
    ) -> tuple[Float[Tensor, "b count"], Bool[Tensor, "b z"]]:
        """Give the foci, each in the middle of the intervals it pierces, and the depths that are left."""
        reach = (score.unsqueeze(-1) / self.weight).sqrt() / self.depth
        left = ratio * self.weight * self.depth**4 > score.unsqueeze(-1)
        begin, end = self.depth - reach, self.depth + reach
        foci = []
        for _ in range(count):
            least = end.where(left, torch.inf).amin(-1, keepdim=True)
            served = left & (begin <= least)
            most = begin.where(served, -torch.inf).amax(-1, keepdim=True)
            middle = (least + most.where(served.any(-1, keepdim=True), 0)) / 2
            foci.append(middle.clamp(self.depth.amin(), self.depth.amax()))
            left = left & ~served
        return torch.cat(foci, dim=-1), left
