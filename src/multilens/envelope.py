"""The score of the thesis' cues in closed form, with its gradient: divided by the depth, stereo is a line and defocus is a V.

At a depth Z stereo of the best pair has the error g Z^2 and defocus of lens i the error h_i Z abs(Z - Zf_i). Divided by Z these
are g Z and h_i abs(Z - Zf_i): a line and some Vs, and the corners of their lower envelope are known. Between two corners one cue
wins, and its share of the score is a sum over depths of w Z^2, w Z^3 and w Z^4, which prefix sums give at once. So the time does
not depend on how many depths there are, and all pairs count as one.
"""

import torch
from jaxtyping import Float
from torch import Tensor

TINY = 1e-300


class DepthMoments:
    """Weighted depths, made ready for sums over any range of them.

    Args:
        depths: mm, in any order.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[Tensor, " z"], weights: Float[Tensor, " z"]) -> None:
        order = depths.argsort()
        self.depths = depths[order].contiguous()
        powers = torch.stack([self.depths**power * weights[order] for power in (2, 3, 4)], dim=-1)
        self.sums = torch.cat([powers.new_zeros(1, 3), powers.cumsum(0)])
        """Of w Z^2, w Z^3 and w Z^4 over all depths before each, [z + 1, 3]."""

    def to(self, device: torch.device) -> "DepthMoments":
        """Give the same on another device."""
        if device == self.depths.device:
            return self
        moved = object.__new__(DepthMoments)
        moved.depths, moved.sums = self.depths.to(device), self.sums.to(device)
        return moved


def mean_least_square(
    gain: Float[Tensor, "*batch"],
    slope: Float[Tensor, "*batch k"],
    focus: Float[Tensor, "*batch k"],
    moments: DepthMoments,
) -> tuple[Float[Tensor, "*batch"], Float[Tensor, "*batch"], Float[Tensor, "*batch k"], Float[Tensor, "*batch k"]]:
    """Give sum_z w_z min(gain Z^2, min_k slope_k Z abs(Z - focus_k))^2 and its derivatives, without autograd.

    A steep V beats a flatter one in an interval around its own focus, and everything flatter in the intersection of these
    intervals; where that holds for several, the steepest of them wins, and where for none, stereo. The derivatives are those
    of the winners: at a tie those of one of them.

    Args:
        gain: g of the best pair, 1/mm, >= 0; infinite where there is no stereo.
        slope: h of each lens and tier, 1/mm, > 0.
        focus: in-focus depth of each, mm, > 0.
        moments: of the depths; float64 like all the rest, for sums of fourth powers need it.

    Returns:
        The mean of the squared error, mm^2, and its derivatives with respect to gain, slope and focus.
    """
    if not slope.shape[-1]:
        fourth = moments.sums[-1, 2]
        return gain.square() * fourth, 2 * gain * fourth, slope, focus
    k = slope.shape[-1]
    low, high = _winning_intervals(gain.unsqueeze(-1), slope, focus)
    ends = torch.searchsorted(moments.depths, torch.cat([low, torch.maximum(low, high)], dim=-1))
    first, last = ends[..., :k].unsqueeze(-2), ends[..., k:].unsqueeze(-2)
    # The ends of the intervals, counted in depths, cut the range into 2 k + 1 pieces, each with one winner.
    cuts = torch.nn.functional.pad(ends.sort(dim=-1).values, (1, 0))
    piece = cuts.unsqueeze(-1)
    held = slope.unsqueeze(-2) * ((first <= piece) & (piece < last))
    steepest, winner = held.max(-1)
    winner = winner.masked_fill_(steepest == 0, k)
    before = moments.sums[cuts]
    after = torch.cat([before[..., 1:, :], moments.sums[-1].expand_as(before[..., :1, :])], dim=-2)
    won = before.new_zeros(*slope.shape[:-1], k + 1, 3)
    won.scatter_add_(-2, winner.unsqueeze(-1).expand_as(before), after - before)
    second, third, fourth = won.unbind(-1)
    by_stereo = fourth[..., -1]
    second, third, fourth = second[..., :-1], third[..., :-1], fourth[..., :-1]
    drift = focus * second - third
    miss = (fourth + focus * (drift - third)).clamp_(min=0)
    # Without stereo its gain is infinite and it wins nowhere.
    gain = gain.masked_fill(by_stereo == 0, 0)
    by_gain, by_slope = gain * by_stereo, slope * miss
    value = (slope * by_slope).sum(-1) + gain * by_gain
    return value, 2 * by_gain, 2 * by_slope, 2 * slope.square() * drift


def _winning_intervals(
    g: Float[Tensor, "*batch 1"], h: Float[Tensor, "*batch k"], f: Float[Tensor, "*batch k"]
) -> tuple[Float[Tensor, "*batch k"], Float[Tensor, "*batch k"]]:
    """Give the interval in which each V lies below all flatter ones and below the line."""
    k = h.shape[-1]
    hf = h * f
    line_low, line_high = hf / (h + g), (hf / (h - g).clamp(min=TINY)).masked_fill(h <= g, torch.inf)
    if k == 1:
        return line_low, line_high
    mine, other, mine_f, other_f = h.unsqueeze(-1), h.unsqueeze(-2), hf.unsqueeze(-1), hf.unsqueeze(-2)
    steeper = mine - other
    # Of equally steep ones the first counts as steeper; their second crossing is at infinity.
    tie_break = torch.full((k, k), TINY, dtype=h.dtype, device=h.device).tril()
    no_flatter = steeper < tie_break
    between, beyond = (mine_f + other_f) / (mine + other), (mine_f - other_f) / steeper.clamp(min=TINY)
    low = torch.minimum(between, beyond).masked_fill_(no_flatter, -torch.inf).amax(-1)
    high = torch.maximum(between, beyond).masked_fill_(no_flatter, torch.inf).amin(-1)
    return torch.maximum(low, line_low), torch.minimum(high, line_high)
