"""One number for many outcomes: their mean, the mean of the worst of them, or the worst."""

import torch
from jaxtyping import Float
from torch import Tensor


def tail_mean(
    values: Float[Tensor, "*batch s"], probability: Float[Tensor, " s"], level: float
) -> Float[Tensor, "*batch"]:
    """Give the mean of the worst 1 - level of all outcomes, the conditional value at risk.

    At level 0 it is the mean, at level 1 the worst of all that can happen. Its gradient is that of the outcomes in the tail, in
    shares of their probability.

    Args:
        values: of each outcome; more is worse.
        probability: of each outcome, >= 0, summing to 1.
        level: from 0 to 1.

    Returns:
        The mean, in the unit of the values.

    Reference:
        R. T. Rockafellar and S. Uryasev, Conditional value-at-risk for general loss distributions (2002), definition 3 and
        proposition 8.
    """
    probability = probability.to(values)
    if level == 1:
        return values.masked_fill(probability == 0, -torch.inf).amax(-1)
    worst_first, order = values.sort(dim=-1, descending=True)
    likely = probability[order]
    before = likely.cumsum(-1) - likely
    share = (1 - level - before).clamp(min=0).minimum(likely)
    return (worst_first * share).sum(-1) / (1 - level)
