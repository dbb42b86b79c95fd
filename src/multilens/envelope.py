"""The score of the thesis' cues in closed form, with its gradient: divided by the depth, stereo is a line and defocus is a V.

At a depth Z stereo of the best pair has the error g Z^2 and defocus of lens i the error h_i Z abs(Z - Zf_i). Divided by Z these
are g Z and h_i abs(Z - Zf_i): a line and some Vs, and the corners of their lower envelope are known. Between two corners one cue
wins, and its share of the score is a sum over depths of w Z^2, w Z^3 and w Z^4, which prefix sums give at once. So the time does
not depend on how many depths there are, and all pairs count as one.
"""

from functools import lru_cache
from math import inf

import numpy as np
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
        self.kind = torch.int16 if len(depths) < 2**15 else torch.int64
        """Of counts of depths: the smaller, the faster."""
        near, span = self.depths[0], self.depths[-1] - self.depths[0]
        self.near, self.cells_per_depth = near, (CELLS - 1) / span
        self.one_a_cell = bool(span > 0 and self._cell(self.depths).bincount().max() <= 1)
        if self.one_a_cell:
            every = torch.arange(CELLS, device=self.depths.device)
            before = torch.searchsorted(self._cell(self.depths), every)
            self.next_depth = torch.cat([self.depths, near.new_full((1,), inf)])[before]
            self.before_cell = before.to(self.kind)

    def count_below(self, depth: Float[Tensor, "*batch"]) -> Int[Tensor, "*batch"]:
        """Give how many depths are less than each; by its cell, where none has two, for a binary search is a branch a step."""
        if not self.one_a_cell:
            return torch.searchsorted(self.depths, depth).to(self.kind)
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
    gain: Float[Tensor, " b"], slope: Float[Tensor, "b k"], focus: Float[Tensor, "b k"], moments: DepthMoments
) -> tuple[Float[Tensor, " b"], Float[Tensor, " b"], Float[Tensor, "b k"], Float[Tensor, "b k"]]:
    """Give sum_z w_z min(gain Z^2, min_k slope_k Z abs(Z - focus_k))^2 and its derivatives, without autograd.

    A steep V beats a flatter one in an interval around its own focus, and everything flatter in the intersection of these
    intervals; where that holds for several, the steepest of them wins, and where for none, stereo. The derivatives are those
    of the winners: at a tie those of one of them. The sums are added up in the same order whatever the batch.

    Args:
        gain: g of the best pair, 1/mm, >= 0; infinite where there is no stereo.
        slope: h of each lens and tier, 1/mm, > 0.
        focus: in-focus depth of each, mm, > 0.
        moments: of the depths; float64 like all the rest, for sums of fourth powers need it.

    Returns:
        The mean of the squared error, mm^2, and its derivatives with respect to gain, slope and focus.
    """
    if not slope.shape[-1]:
        fourth = moments.sums[2, -1]
        return gain.square() * fourth, 2 * gain * fourth, slope, focus
    # Flattest first: then each has only those before it to beat.
    rising, order = slope.sort()
    # From here on the batch comes last, so that every step runs along memory.
    curves = torch.stack([focus.gather(-1, order), rising, rising]).transpose(1, 2).contiguous()
    focus, slope, lift = curves
    lift.mul_(focus)
    won = _won(_winning_intervals(gain, curves[1:]), moments)
    second, third, fourth = won[:, 1:]
    drift = focus * second - third
    miss = (fourth + focus * (drift - third)).clamp_(min=0)
    by_stereo = won[2, 0]
    # Without stereo its gain is infinite and it wins nowhere.
    gain = gain.masked_fill(by_stereo == 0, 0)
    by_gain, by_slope = gain * by_stereo, slope * miss
    value = (slope * by_slope).cumsum(0)[-1] + gain * by_gain
    own = torch.stack([by_slope, slope.square() * drift]).mul_(2).transpose(1, 2)
    by_slope, by_focus = own.new_empty(own.shape).scatter_(-1, order.expand_as(own), own)
    return value, 2 * by_gain, by_slope, by_focus


def _winning_intervals(gain: Float[Tensor, " b"], curves: Float[Tensor, "2 k b"]) -> Float[Tensor, "2 k b"]:
    """Give the interval in which each V, slope and lift, lies below the line and all Vs before it, which are no steeper."""
    slope, lift = curves
    # The greatest low end and the least high end, with its sign turned, in one go.
    ends = torch.stack([lift / (slope + gain), lift / (gain - slope).clamp_(max=-TINY)])
    k = len(slope)
    if k > 1:
        for stretch in _crossings(curves).split([*range(k - 1, 0, -1)], dim=1):
            some = ends.narrow(1, k - stretch.shape[1], stretch.shape[1])
            torch.maximum(some, stretch, out=some)
    torch.maximum(ends[0], ends[1].neg_(), out=ends[1])
    return ends


def _crossings(curves: Float[Tensor, "2 k b"]) -> Float[Tensor, "2 p b"]:
    """Give where each two Vs cross, the nearer place and the farther with its sign turned, in the order of `_pairs_by_offset`."""
    steeper, flatter = (curves.index_select(1, side) for side in _pairs_by_offset(curves.shape[1], curves.device))
    total = steeper + flatter
    between = total[1].div_(total[0])
    # Of equally steep ones the second crossing is at infinity.
    apart = steeper.sub_(flatter)
    beyond = apart[1].div_(apart[0].clamp_(min=TINY))
    # What is not needed any more takes the result: memory that is in the cache already.
    torch.minimum(between, beyond, out=flatter[0])
    torch.maximum(between, beyond, out=flatter[1]).neg_()
    return flatter


def _won(ends: Float[Tensor, "2 k b"], moments: DepthMoments) -> Float[Tensor, "3 k+1 b"]:
    """Give the sums of w Z^2, w Z^3 and w Z^4 over the depths that the line wins and each V: the last of several wins."""
    _, k, batch = ends.shape
    # The ends of the intervals, counted in depths, cut the range into pieces, each with one winner.
    ends = moments.count_below(ends)
    cuts = _sorted_rows(ends.flatten(0, 1).T.contiguous()).T.contiguous()
    first, last = ends.unsqueeze(2)
    rank = torch.arange(1, k + 1, dtype=ends.dtype, device=ends.device).view(k, 1, 1)
    # Counted, not compared: 1 from the first cut of a V to before its last, 0 elsewhere. Comparisons and masks are slow.
    within = torch.minimum(cuts - (first - 1), last - cuts).clamp_(0, 1)
    winner = within.mul_(rank).amax(0).long()
    after = torch.nn.functional.pad(cuts.long(), (0, 0, 0, 1), value=len(moments.depths))
    before = moments.sums.gather(1, after.view(1, -1).expand(3, -1)).view(3, -1, batch)
    piece = before.diff(dim=1).flatten(1)
    place = winner.mul_(batch).add_(torch.arange(batch, device=ends.device)).view(1, -1).expand_as(piece)
    won = piece.new_zeros(3, (k + 1) * batch).scatter_add_(1, place, piece).view(3, -1, batch)
    # Before the first cut the line wins.
    won[2, 0].add_(before[2, 0])
    return won


def _sorted_rows(numbers: Int[Tensor, "b m"]) -> Int[Tensor, "b m"]:
    # NumPy sorts short rows some times faster than torch, where it can.
    return torch.from_numpy(np.sort(numbers.numpy())) if numbers.device.type == "cpu" else numbers.sort().values


@lru_cache(64)
def _pairs_by_offset(k: int, device: torch.device) -> tuple[Int[Tensor, " p"], Int[Tensor, " p"]]:
    """Give the later and the earlier of every pair of k, by how far they are apart: then the later of a stretch are in a row."""
    pairs = [(i + offset, i) for offset in range(1, k) for i in range(k - offset)]
    later, earlier = torch.tensor(pairs, dtype=torch.int64, device=device).reshape(-1, 2).unbind(-1)
    return later, earlier
