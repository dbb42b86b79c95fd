"""Stereo from many views of one point together: what they tell of its depth, more than any pair and less than all pairs apart.

A lens at p_i with the precision w_i, one over the variance of the direction in which it sees a point, sees the point at depth Z
in the direction d - p_i / Z, up to its noise. Two unknowns, the direction d and 1/Z, are fitted to all views by weighted least
squares. What the views tell of 1/Z is the spread of the lenses about their weighted mean,

    I = sum_i w_i |p_i - m|^2 = sum_{i<j} w_i w_j b_ij^2 / sum_i w_i,     m = sum_i w_i p_i / sum_i w_i.

Two lenses give b^2 / (1 / w_1 + 1 / w_2), the pair's own. All in millimetres, angles in radians.
"""

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.geometry.pairs import pair_indices


def view_information(
    baseline: Float[Tensor, "*batch p"],
    precision: Float[Tensor, "*#batch n #z"],
    usable: Float[Tensor, "*#batch p z"] | None = None,
) -> Float[Tensor, "*batch _"]:
    """Give what several views tell of the inverse depth of a point, one over the variance of 1/Z.

    Pairs that may be used in part, or not at all, have a factor u_ij from 0 to 1. A lens counts as much as its best pair may be
    used, w'_i = w_i max_j u_ij, and a pair as much as it may be used beyond that, u_ij / max(max_k u_ik, max_k u_jk):

        I = sum_{i<j} w'_i w'_j u'_ij b_ij^2 / sum_i w'_i.

    It is never less than what the best pair tells alone, and never more than what all views tell. It may fall where a pair
    may be used more or a lens sees better: one that has but a near neighbour draws the mean to itself.

    Args:
        baseline: distance of the two lenses of every pair, in the order of `pair_indices`, mm.
        precision: of each lens' direction, rad^-2, >= 0; at one depth or at every depth.
        usable: of each pair at each depth, from 0 to 1; None where all are.

    Returns:
        Information on 1/Z, mm^2, at one depth or at every depth; times 1/Z^4 it is that on Z.

    Reference:
        docs/metrics.md, "Many views of one point".
    """
    count = precision.shape[-2]
    first, second = pair_indices(count, baseline.device)
    square = baseline.square().unsqueeze(-1)
    if usable is None:
        return _spread(square, precision, first, second)
    best = usable[..., _pairs_of_each(count, baseline.device), :].amax(-2)
    tiny = torch.finfo(usable.dtype).tiny
    beyond = usable / torch.maximum(best[..., first, :], best[..., second, :]).clamp(min=tiny)
    together = _spread(square * beyond, precision * best, first, second)
    alone = square * usable * _in_series(precision[..., first, :], precision[..., second, :])
    return torch.maximum(together, alone.amax(-2))


def _spread(square: Tensor, precision: Tensor, first: Tensor, second: Tensor) -> Float[Tensor, "*batch _"]:
    tiny = torch.finfo(precision.dtype).tiny
    share = precision / precision.sum(-2, keepdim=True).clamp(min=tiny)
    return (square * precision[..., first, :] * share[..., second, :]).sum(-2)


def _in_series(first: Tensor, second: Tensor) -> Tensor:
    """Give 1 / (1 / first + 1 / second), 0 where one of them is."""
    return first * second / (first + second).clamp(min=torch.finfo(first.dtype).tiny)


def _pairs_of_each(count: int, device: torch.device) -> Int[Tensor, "n m"]:
    """Give for each lens the places of its pairs in the order of `pair_indices`."""
    first, second = pair_indices(count, device)
    pairs = torch.arange(len(first), device=device)
    return torch.stack([pairs[(first == lens) | (second == lens)] for lens in range(count)])
