"""Smooth stand-ins for a minimum and a maximum, and what their gradients do."""

from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable


def soft_minimum(values: Float[Tensor, "*batch k z"], temperature: float) -> Float[Tensor, "*batch z"]:
    """Give a smooth lower envelope of positive values, (sum_k v_k^(-1/T))^(-T), differentiable once.

    It scales as its values do, never exceeds the least, and reaches it as T goes to 0; the ratio is at least k^(-T). A soft
    minimum of soft minima is the soft minimum of all. At T = 1 and with squared errors for values it is inverse-variance
    fusion. Its gradient is shared among the values in proportion to v_k^(-1/T - 1): at a tie of m values each gets the same
    share; values below 1e-30 (1e-200 in double) count as that, so that at 0 the gradient is finite.

    Args:
        values: >= 0, any unit.
        temperature: T, > 0, without unit.

    Returns:
        The envelope, in the unit of the values.
    """
    return _SoftMinimum.apply(values, temperature)  # type: ignore[return-value]


class _SoftMinimum(Function):
    """With its gradient written out, d/dv_k = (m / v_k) share_k, which takes a third of the passes that autograd would."""

    @staticmethod
    def forward(ctx: Any, values: Tensor, temperature: float) -> Tensor:
        values = values.clamp(min=1e-30 if values.dtype.itemsize < 8 else 1e-200)
        power = values.log().mul_(-1 / temperature)
        total = power.logsumexp(-2, keepdim=True)
        minimum = (total * -temperature).exp_()
        # Shares below 1e-12 are 0: the processor takes a hundred times as long for numbers too small to be normal.
        share = torch.threshold_(power.sub_(total).clamp_(min=-30).exp_(), 1e-12, 0)
        ctx.save_for_backward(share.mul_(minimum).div_(values))
        return minimum.squeeze(-2)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, None]:  # type: ignore[override]
        (slope,) = ctx.saved_tensors
        return slope * grad.unsqueeze(-2), None


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
