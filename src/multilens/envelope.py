"""The best cue at every depth in closed form: divided by the depth, stereo is a line and defocus is a V.

At a depth Z stereo of the best pair has the error g Z^2 and defocus of lens i the error h_i Z abs(Z - Zf_i). Divided by Z these
are g Z and h_i abs(Z - Zf_i): a line and some Vs, and the corners of their lower envelope are known. Between two corners one cue
wins, and its share of the score is a sum over depths of w Z^2, w Z^3 and w Z^4, which prefix sums give at once. So the time does
not depend on how many depths there are, and all pairs count as one.
"""

from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable


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
) -> Float[Tensor, "*batch"]:
    """Give sum_z w_z min(gain Z^2, min_k slope_k Z abs(Z - focus_k))^2, differentiable once.

    A steep V beats a flatter one in an interval around its own focus, and everything flatter in the intersection of these
    intervals; where that holds for several, the steepest of them wins, and where for none, stereo. The gradient is that of
    the winners: at a tie that of one of them.

    Args:
        gain: g of the best pair, 1/mm, >= 0; infinite where there is no stereo.
        slope: h of each lens and tier, 1/mm, > 0.
        focus: in-focus depth of each, mm, > 0.
        moments: of the depths.

    Returns:
        The mean of the squared error, mm^2. Computed in float64 whatever the inputs are; sums of fourth powers need it.
    """
    if not slope.shape[-1]:
        return gain.square() * moments.sums[-1, 2].to(gain)
    return _MeanLeastSquare.apply(gain, slope, focus, moments)  # type: ignore[return-value]


class _MeanLeastSquare(Function):
    @staticmethod
    def forward(ctx: Any, gain: Tensor, slope: Tensor, focus: Tensor, moments: DepthMoments) -> Tensor:
        kind = slope.dtype
        g, h, f = gain.double().unsqueeze(-1), slope.double(), focus.double()
        low, high = _winning_intervals(g, h, f)
        first = torch.searchsorted(moments.depths, low.contiguous())
        last = torch.searchsorted(moments.depths, high.contiguous()).maximum(first)
        # The ends of the intervals, counted in depths, cut the range into 2 k + 1 pieces, each with one winner.
        ends = torch.cat([first, last], dim=-1).sort(dim=-1).values
        begin = torch.nn.functional.pad(ends, (1, 0))
        end = torch.nn.functional.pad(ends, (0, 1), value=len(moments.depths))
        piece, lens = begin.unsqueeze(-1), (first.unsqueeze(-2), last.unsqueeze(-2))
        held = torch.where((lens[0] <= piece) & (piece < lens[1]), h.unsqueeze(-2), 0.0)
        steepest, winner = held.max(-1)
        winner = winner.where(steepest > 0, h.shape[-1])
        sums = moments.sums[end] - moments.sums[begin]
        won = sums.new_zeros(*h.shape[:-1], h.shape[-1] + 1, 3)
        won.scatter_add_(-2, winner.unsqueeze(-1).expand_as(sums), sums)
        second, third, fourth = won[..., :-1, :].unbind(-1)
        miss = (fourth - 2 * f * third + f * f * second).clamp(min=0)
        by_stereo = won[..., -1, 2]
        # Without stereo its gain is infinite and it wins nowhere.
        g = g.squeeze(-1).where(by_stereo > 0, 0.0)
        ctx.save_for_backward(2 * g * by_stereo, 2 * h * miss, 2 * h * h * (f * second - third))
        ctx.kind = kind
        return ((h * h * miss).sum(-1) + g * g * by_stereo).to(kind)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, Tensor, Tensor, None]:  # type: ignore[override]
        by_gain, by_slope, by_focus = (part.to(ctx.kind) for part in ctx.saved_tensors)
        each = grad.unsqueeze(-1)
        return grad * by_gain, each * by_slope, each * by_focus, None


def _winning_intervals(
    g: Float[Tensor, "*batch 1"], h: Float[Tensor, "*batch k"], f: Float[Tensor, "*batch k"]
) -> tuple[Float[Tensor, "*batch k"], Float[Tensor, "*batch k"]]:
    """Give the interval in which each V lies below all flatter ones and below the line."""
    hf = h * f
    steeper = h.unsqueeze(-1) - h.unsqueeze(-2)
    # Of equally steep ones the first counts as steeper; their second crossing is at infinity.
    tie_break = torch.full_like(steeper[..., :, :], 1e-300).tril(-1)
    flatter = steeper >= tie_break
    flatter.diagonal(dim1=-2, dim2=-1).fill_(False)
    between = (hf.unsqueeze(-1) + hf.unsqueeze(-2)) / (h.unsqueeze(-1) + h.unsqueeze(-2))
    beyond = (hf.unsqueeze(-1) - hf.unsqueeze(-2)) / steeper.clamp(min=1e-300)
    low = torch.where(flatter, torch.minimum(between, beyond), -torch.inf).amax(-1)
    high = torch.where(flatter, torch.maximum(between, beyond), torch.inf).amin(-1)
    line_low, line_high = hf / (h + g), torch.where(h > g, hf / (h - g).clamp(min=1e-300), torch.inf)
    return torch.maximum(low, line_low), torch.minimum(high, line_high)
