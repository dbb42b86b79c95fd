"""A minimum, a smooth maximum, a smooth step and an exponential that ends, and what their gradients do."""

from typing import Any

from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable


def least(values: Float[Tensor, "*batch k z"]) -> Float[Tensor, "*batch z"]:
    """Give the least of k values, differentiable once; its gradient goes to the least alone, at a tie in equal shares.

    As `amin`, with half the passes backward: most of what a search computes is this.
    """
    return _Least.apply(values)  # type: ignore[return-value]


class _Least(Function):
    @staticmethod
    def forward(ctx: Any, values: Tensor) -> Tensor:
        smallest = values.amin(-2)
        ctx.save_for_backward(values == smallest.unsqueeze(-2))
        return smallest

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> Tensor:  # type: ignore[override]
        (wins,) = ctx.saved_tensors
        return wins * (grad / wins.sum(-2)).unsqueeze(-2)


def soft_maximum(values: Float[Tensor, "*batch m"], width: float) -> Float[Tensor, "*batch"]:
    """Give a smooth maximum of values of any sign, w log sum_m exp(v_m / w).

    It is never below the maximum and at most w log(m) above it. Its gradient is a softmax: shares of one that go to the
    largest values, equal at a tie.

    Args:
        values: any unit.
        width: w, > 0, in the same unit.

    Returns:
        The smooth maximum, in the unit of the values.
    """
    return (values / width).logsumexp(-1) * width


def smooth_step(values: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give 0 up to 0, 1 from 1 on, and x^2 (3 - 2 x) between them.

    Its gradient is continuous: 0 outside, 6 x (1 - x) between.
    """
    within = values.clamp(0, 1)
    return within.square() * (3 - 2 * within)


def tangent_exp(values: Float[Tensor, "..."], ceiling: float) -> Float[Tensor, "..."]:
    """Give exp(x) up to a ceiling and its tangent from there on, exp(c) (1 + x - c): never infinite, differentiable once.

    Its gradient is exp(min(x, c)): continuous, and nowhere 0 where the number is large.

    Args:
        values: x, of any size.
        ceiling: c, from which on the tangent goes on, small enough that exp(c) can be held.

    Returns:
        Numbers > 0.
    """
    return _TangentExp.apply(values, ceiling)  # type: ignore[return-value]


class _TangentExp(Function):
    @staticmethod
    def forward(ctx: Any, values: Tensor, ceiling: float) -> Tensor:
        slope = values.clamp(max=ceiling).exp_()
        ctx.save_for_backward(slope)
        return slope * (values - ceiling).clamp_(min=0).add_(1)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, None]:  # type: ignore[override]
        (slope,) = ctx.saved_tensors
        return grad * slope, None
