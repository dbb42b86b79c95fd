"""The best foci of equal apertures, by dynamic programming along the depths: where a search had better begin."""

import torch
from jaxtyping import Float
from torch import Tensor

MOST_ENDS = 96
"""Places along the depths at which a stretch may begin or end; between them the polish decides."""


class Stretches:
    """Depths shared out in stretches, each served by one focus, with stereo between them.

    Equal apertures share depths out so: divided by the depth, all their errors are equally steep, and the nearest focus wins.

    Args:
        depths: mm, in any order.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[Tensor, " z"], weights: Float[Tensor, " z"]) -> None:
        order = depths.argsort()
        depth, weight = depths[order], weights[order]
        ends = torch.linspace(0, len(depth), min(len(depth), MOST_ENDS) + 1).round().long().unique()
        sums = [torch.cat([depth.new_zeros(1), (weight * depth**power).cumsum(0)])[ends] for power in (2, 3, 4)]
        second, third, fourth = (each.unsqueeze(0) - each.unsqueeze(1) for each in sums)
        self.to_end = sums[2]
        """Sum of w Z^4 over all depths before each end."""
        forward = second > 0
        # More foci than depths are left over: an empty stretch costs nothing, its focus is at the depth beside it.
        empty = torch.eye(len(ends), dtype=torch.bool, device=depth.device)
        beside = depth[ends.clamp(max=len(depth) - 1)]
        self.focus = torch.where(empty, beside, third / second.where(forward, 1))
        """Best focus of a stretch from one end to another, sum w Z^3 / sum w Z^2, mm."""
        cost = (fourth - third * self.focus).clamp(min=0)
        self.cost = cost.where(forward, torch.inf).masked_fill(empty, 0)
        """Least sum of w Z^2 (Z - Zf)^2 over it, mm^4; infinite where it would end before it begins."""

    def best_foci(self, gain: Float[Tensor, " b"], slope: Float[Tensor, " b"], count: int) -> Float[Tensor, "b count"]:
        """Give the foci that serve the depths best, nearest first.

        Args:
            gain: of stereo, err = gain Z^2, 1/mm; infinite where there is none.
            slope: of defocus, err = slope Z abs(Z - Zf), 1/mm.
            count: how many foci, >= 1.

        Returns:
            mm. Where stereo is better everywhere a focus is that of the last depths.
        """
        # In units of the slope: only the ratio decides. Where there is no stereo it is dearer than anything.
        ratio = (gain / slope).nan_to_num(posinf=1e6).clamp(max=1e6).square().unsqueeze(-1)
        by_stereo = ratio * self.to_end
        least, steps = by_stereo, []
        batch = torch.arange(len(gain), device=gain.device)
        for _ in range(count):
            ended, begun = (least.unsqueeze(-1) + self.cost).min(1)
            # After the stretch stereo may serve until a later end.
            later, at = (ended - by_stereo).cummin(-1)
            least = later + by_stereo
            steps.append((begun, at))
        end = torch.full_like(batch, len(self.to_end) - 1)
        foci = []
        for begun, at in reversed(steps):
            end = at[batch, end]
            start = begun[batch, end]
            foci.append(self.focus[start, end])
            end = start.clamp(min=0)
        return torch.stack(foci[::-1], dim=-1)
