"""The first step: lenses that overlap, or leave the back, part and come inside, whatever that does to the score."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.penalty import Price
from multilens.search.variables import Variables

STEPS = 20
"""Enough for most of many lenses; what still overlaps then is left to the barrier."""

LENGTH = 0.02
"""Of a step in units of each unknown's range."""


def part(variables: Variables, price: Price, share: Float[Tensor, "b v"]) -> Float[Tensor, "b v"]:
    """Let every layout descend the price of the room that it lacks, by Adam; one that lacks none stays as it is.

    Args:
        variables: how a vector becomes a layout.
        price: of missing room, made for the question.
        share: where the layouts begin, every unknown.

    Returns:
        Vectors whose lenses overlap less. A layout whose price has no finite slope stays as it was.
    """
    free = torch.zeros_like(variables.low).index_fill(0, variables.free, 1)
    upper = torch.ones_like(variables.low).index_copy(0, variables.free, variables.upper)
    mean, spread = torch.zeros_like(share), torch.zeros_like(share)
    for _ in range(STEPS):
        point = share.detach().requires_grad_()
        missing = price(variables.layout_of(point))
        if not (missing > 0).any():
            break
        (slope,) = torch.autograd.grad(missing.sum(), point)
        slope = torch.where(slope.isfinite(), slope, 0) * free
        mean, spread = 0.8 * mean + 0.2 * slope, 0.9 * spread + 0.1 * slope.square()
        step = LENGTH * mean / (spread.sqrt() + torch.finfo(share.dtype).eps)
        moved = (share - step).clamp(min=0).minimum(upper)
        share = torch.where((missing > 0).unsqueeze(-1), moved, share)
    return share.detach()
