"""The score of the thesis' cues in closed form, with its gradient: divided by the depth, stereo is a line and defocus is a V.

At a depth Z stereo of the best pair has the error g Z^2 and defocus of lens i the error h_i Z abs(Z - Zf_i). Divided by Z these
are g Z and h_i abs(Z - Zf_i): a line and some Vs, and the corners of their lower envelope are known. Between two corners one cue
wins, and its share of the score is a sum over depths of w Z^2, w Z^3 and w Z^4, which prefix sums give at once. So the time does
not depend on how many depths there are, and all pairs count as one.
"""

from functools import lru_cache
from math import inf

import torch
from jaxtyping import Float, Int
from torch import Tensor

TINY = 1e-300

CELLS = 4096
"""Equal parts of the range of depths by which a depth is looked up."""


class DepthMoments:
    """Weighted depths, made ready for sums over any range of them.

    Args:
        depths: mm, in any order.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[Tensor, " z"], weights: Float[Tensor, " z"]) -> None:
        order = depths.argsort()
        self.depths = depths[order].contiguous()
        powers = torch.stack([self.depths**power * weights[order] for power in (2, 3, 4)])
        self.sums = torch.cat([powers.new_zeros(3, 1), powers.cumsum(1)], dim=1)
        """Of w Z^2, w Z^3 and w Z^4 over all depths before each, [3, z + 1]."""
        near, span = self.depths[0], self.depths[-1] - self.depths[0]
        self.near, self.cells_per_depth = near, (CELLS - 1) / span
        self.one_a_cell = bool(span > 0 and self._cell(self.depths).bincount().max() <= 1)
        if self.one_a_cell:
            every = torch.arange(CELLS, device=self.depths.device)
            self.before_cell = torch.searchsorted(self._cell(self.depths), every)
            self.next_depth = torch.cat([self.depths, near.new_full((1,), inf)])[self.before_cell]

    def count_below(self, depth: Float[Tensor, "*batch"]) -> Int[Tensor, "*batch"]:
        """Give how many depths are less than each; by its cell, where none has two, for a binary search is a branch a step."""
        if not self.one_a_cell:
            return torch.searchsorted(self.depths, depth)
        cell = self._cell(depth).flatten()
        beyond = self.next_depth.index_select(0, cell).view_as(depth) < depth
        return self.before_cell.index_select(0, cell).view_as(depth).add_(beyond)

    def _cell(self, depth: Tensor) -> Tensor:
        # Each step is monotonic however it rounds, so that of depths in other cells the order is known.
        # What is no number has a cell too, and stays none in the sums.
        return (depth - self.near).mul_(self.cells_per_depth).nan_to_num_(nan=0.0).clamp_(0, CELLS - 1).long()

    def to(self, device: torch.device) -> "DepthMoments":
        """Give the same on another device."""
        if device == self.depths.device:
            return self
        moved = object.__new__(DepthMoments)
        for name, value in vars(self).items():
            setattr(moved, name, value.to(device) if isinstance(value, Tensor) else value)
        return moved


def mean_least_square(
    gain: Float[Tensor, " b"], slope: Float[Tensor, "k b"], focus: Float[Tensor, "k b"], moments: DepthMoments
) -> tuple[Float[Tensor, " b"], Float[Tensor, " b"], Float[Tensor, "k b"], Float[Tensor, "k b"]]:
    """Give sum_z w_z min(gain Z^2, min_k slope_k Z abs(Z - focus_k))^2 and its derivatives, without autograd.

    A steep V beats a flatter one in an interval around its own focus, and everything flatter in the intersection of these
    intervals; where that holds for several, the steepest of them wins, and where for none, stereo. The derivatives are those
    of the winners: at a tie those of one of them. The batch comes last, so that every step runs along memory, and the sums
    are added up in the same order whatever the batch.

    Args:
        gain: g of the best pair, 1/mm, >= 0; infinite where there is no stereo.
        slope: h of each lens and tier, 1/mm, > 0.
        focus: in-focus depth of each, mm, > 0.
        moments: of the depths; float64 like all the rest, for sums of fourth powers need it.

    Returns:
        The mean of the squared error, mm^2, and its derivatives with respect to gain, slope and focus.
    """
    if not len(slope):
        fourth = moments.sums[2, -1]
        return gain.square() * fourth, 2 * gain * fourth, slope, focus
    # Steepest first: then each has only those after it to beat.
    order = slope.T.contiguous().argsort(descending=True, stable=True).T.contiguous()
    slope, focus = slope.gather(0, order), focus.gather(0, order)
    won = _won(*_winning_intervals(gain, slope, focus), moments)
    second, third, fourth = won[:, :-1]
    drift = focus * second - third
    miss = (fourth + focus * (drift - third)).clamp_(min=0)
    by_stereo = won[2, -1]
    # Without stereo its gain is infinite and it wins nowhere.
    gain = gain.masked_fill(by_stereo == 0, 0)
    by_gain, by_slope = gain * by_stereo, slope * miss
    value = (slope * by_slope).cumsum(0)[-1] + gain * by_gain
    own = torch.stack([by_slope, slope.square() * drift]).mul_(2)
    by_slope, by_focus = torch.empty_like(own).scatter_(1, order.expand_as(own), own)
    return value, 2 * by_gain, by_slope, by_focus


def _won(low: Float[Tensor, "k b"], high: Float[Tensor, "k b"], moments: DepthMoments) -> Float[Tensor, "3 k+1 b"]:
    """Give the sums of w Z^2, w Z^3 and w Z^4 over the depths that each V wins, and the line last: the first of several wins."""
    k, batch = low.shape
    ends = moments.count_below(torch.cat([low, torch.maximum(low, high)]))
    # The ends of the intervals, counted in depths, cut the range into 2 k + 1 pieces, each with one winner.
    cuts = torch.nn.functional.pad(ends.T.contiguous().sort(dim=-1).values.T, (0, 0, 1, 0))
    first, last = ends.view(2, k, 1, batch).unbind()
    rank = torch.arange(k, 0, -1, dtype=torch.int16, device=low.device).view(k, 1, 1)
    # Multiplied, not masked: a mask is a branch for each number.
    winner = k - (((first <= cuts) & (cuts < last)).to(torch.int16).mul_(rank)).amax(0).long()
    before = moments.sums.gather(1, cuts.reshape(1, -1).expand(3, -1)).view(3, -1, batch)
    piece = torch.cat([before[:, 1:], moments.sums[:, -1:, None].expand(3, 1, batch)], dim=1).sub_(before)
    return piece.new_zeros(3, k + 1, batch).scatter_add_(1, winner.expand_as(piece), piece)


def _winning_intervals(
    gain: Float[Tensor, " b"], slope: Float[Tensor, "k b"], focus: Float[Tensor, "k b"]
) -> tuple[Float[Tensor, "k b"], Float[Tensor, "k b"]]:
    """Give the interval in which each V lies below all that come after it, which are no steeper, and below the line."""
    k, lift = len(slope), slope * focus
    low, high = lift / (slope + gain), lift / (slope - gain).clamp_(min=TINY)
    if k == 1:
        return low, high
    mine, other = _pairs_by_offset(k, slope.device)
    mine_lift, other_lift = lift.index_select(0, mine), lift.index_select(0, other)
    mine, other = slope.index_select(0, mine), slope.index_select(0, other)
    between = (mine_lift + other_lift).div_(mine + other)
    # Of equally steep ones the second crossing is at infinity.
    beyond = mine_lift.sub_(other_lift).div_(mine.sub_(other).clamp_(min=TINY))
    # The greatest low end and the least high end, with its sign turned, in one go.
    ends = torch.stack([low, high.neg_()])
    crossings = torch.stack([torch.minimum(between, beyond), torch.maximum(between, beyond).neg_()])
    for stretch in crossings.split([*range(k - 1, 0, -1)], dim=1):
        some = ends.narrow(1, 0, stretch.shape[1])
        torch.maximum(some, stretch, out=some)
    return ends[0], ends[1].neg()


@lru_cache(64)
def _pairs_by_offset(k: int, device: torch.device) -> tuple[Int[Tensor, " p"], Int[Tensor, " p"]]:
    """Give both ends of every pair of k, by how far they are apart: then the first ends of a stretch are 0, 1, 2, ..."""
    pairs = [(i, i + offset) for offset in range(1, k) for i in range(k - offset)]
    first, second = torch.tensor(pairs, dtype=torch.int64, device=device).reshape(-1, 2).unbind(-1)
    return first, second
