"""What a search sees of a texture that fades: finite, differentiable once, and never better than what may be claimed.

A claim ends at a cliff, y = 0 with y = log(r^2 / t^2): beyond it the texture counts as lost. Ahead of the cliff the smooth error
bends upward, so that it is already as good as none there, and beyond it goes on rising, so that there is always a way back.
Most of what a search computes is here: the derivatives are written out, which saves half of the passes over all depths.
"""

from math import pi
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable

from multilens.optics.photometry import relative_noise_squared
from multilens.optics.texture import FALL, FINEST, log_diffraction_transfer

FADE = 0.5
"""Of y, ahead of the cliff, where the smooth error begins to bend: there r is 0.78 of the largest."""

EDGE = 0.05
"""Of the cutoff of diffraction, ahead of the finest texture that counts as seen, where it begins to bend."""

STEEPNESS = 12.0
"""Of y, by how much it is raised at the cliff: r by exp(6), 400 times."""

CEILING = 16.0
"""Of y, where the error is 3000 times the largest, as good as none: from there r^2 rises in a straight line with y."""


def fading_in_focus(
    radius: Float[Tensor, "*batch n 1"],
    light: Float[Tensor, "n 1"],
    full_well: Float[Tensor, "n 1"],
    read_noise: Float[Tensor, "n 1"],
    cutoff_radius: Float[Tensor, "#n #z"],
    rest: Float[Tensor, "#n #z"],
) -> Float[Tensor, "*batch n #z"]:
    """Give y in focus as a search sees it: noise, diffraction with its bend, and the rest, which no aperture changes.

    Args:
        radius: A, mm, > 0.
        light: photoelectrons with an aperture radius of 1 mm.
        full_well: photoelectrons that the mean signal may reach.
        read_noise: electrons.
        cutoff_radius: aperture radius that just no longer passes the texture, mm.
        rest: added to y.
    """
    return _FadingInFocus.apply(radius, light, full_well, read_noise, cutoff_radius, rest)  # type: ignore[return-value]


def faded(
    log_error: Float[Tensor, "*batch n #z"], reach: Float[Tensor, "*batch n #z"], defocus: Float[Tensor, "*batch n z"]
) -> Float[Tensor, "*batch n z"]:
    """Give r^2 / t^2 after blur as a search sees it, exp(y + 12 max(0, 1 + y / 0.5)^2) up to its ceiling, y with the blur in it.

    Args:
        log_error: y in focus.
        reach: R, phase of the blur per defocus, mm: the blur adds (R u)^2 to y.
        defocus: u = 1/Z - 1/Zf, 1/mm.
    """
    return _Faded.apply(log_error, reach, defocus)  # type: ignore[return-value]


class _FadingInFocus(Function):
    @staticmethod
    def forward(
        ctx: Any, radius: Tensor, light: Tensor, full_well: Tensor, read_noise: Tensor, cutoff: Tensor, rest: Tensor
    ) -> Tensor:
        collected, share = light * radius.square(), cutoff / radius
        signal, bend = collected.minimum(full_well), ((share - FINEST) / EDGE + 1).clamp(min=0)
        transfer = log_diffraction_transfer(share)
        noise = relative_noise_squared(signal, read_noise)
        if any(ctx.needs_input_grad):
            # In the logarithm of A: the signal grows by 2 until the well is full, the share of the cutoff falls by itself.
            by_light = (collected < full_well) * (2 / (signal * noise) - 4)
            seen = share.clamp(max=FINEST)
            by_share = 8 / pi * (1 - seen.square()).sqrt() / (transfer + FALL * (share - seen)).exp()
            slope = by_light - share * (by_share + 2 * STEEPNESS / EDGE * bend)
            ctx.save_for_backward(slope / radius)
        return noise.log() - 2 * transfer + rest + STEEPNESS * bend.square()

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor | None, ...]:  # type: ignore[override]
        (slope,) = ctx.saved_tensors
        return (grad * slope).sum(-1, keepdim=True), None, None, None, None, None


class _Faded(Function):
    @staticmethod
    def forward(ctx: Any, log_error: Tensor, reach: Tensor, defocus: Tensor) -> Tensor:
        blur = reach * defocus
        y = torch.addcmul(log_error, blur, blur)
        bend = (y / FADE).add_(1).clamp_(min=0)
        y.addcmul_(bend, bend, value=STEEPNESS)
        below = y.clamp(max=CEILING)
        beyond = y.sub_(below).add_(1)
        value = below.exp_()
        if any(ctx.needs_input_grad):
            slope = torch.addcmul(value, value, bend, value=2 * STEEPNESS / FADE)
            ctx.save_for_backward(slope, blur, reach, defocus)
            ctx.in_focus = log_error.shape
        return beyond.mul_(value)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, Tensor, Tensor]:  # type: ignore[override]
        slope, blur, reach, defocus = ctx.saved_tensors
        by_height = grad * slope
        by_blur = blur.mul(by_height).mul_(2)
        by_defocus = by_blur * reach
        by_reach = by_blur.mul_(defocus)
        return _like(by_height, ctx.in_focus), _like(by_reach, reach.shape), by_defocus


def _like(values: Tensor, shape: torch.Size) -> Tensor:
    """Add over what was spread out."""
    return values.sum_to_size(shape) if values.shape != shape else values
