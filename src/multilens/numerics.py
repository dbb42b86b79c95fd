"""A minimum, a smooth maximum and a steep rise, and what their gradients do."""

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


def steep_rise(values: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give 0 up to 0, 1 from 1 on, and 1 - (1 - x)^3 between them: most of the way at once, the rest gently.

    Its gradient jumps from 0 to 3 at 0 and falls to 0 at 1. That of its square is continuous everywhere.
    """
    return 1 - (1 - values.clamp(0, 1)) ** 3
