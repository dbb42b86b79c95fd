"""The score of the thesis' cues and its gradient at once, without a graph: what a search asks for most often."""

from collections.abc import Sequence
from math import inf
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable

from multilens.cues import NANOMETRE, Cue, LensDefocus, PairStereo
from multilens.envelope import DepthMoments, mean_least_square
from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.lens import Lens

Slopes = tuple[Float[Tensor, "*batch n 2"], Float[Tensor, "*batch n"], Float[Tensor, "*batch n t"]]
"""Derivatives with respect to position, aperture radius and focus."""


class ClosedForm:
    """The score of given lenses at given depths by stereo of pairs and defocus of lenses, either or both.

    Args:
        lenses: what is known of each.
        cues: each of another kind.
        moments: of the depths.
    """

    def __init__(self, lenses: Sequence[Lens], cues: Sequence[Cue], moments: DepthMoments) -> None:
        self.moments, device = moments, moments.depths.device
        stereo = next((cue for cue in cues if isinstance(cue, PairStereo)), None)
        self.first, self.second = pair_indices(len(lenses) if stereo else 1, device)
        if stereo:
            self.noise = stereo.noise(lenses, torch.float64).to(device)
        defocus = any(isinstance(cue, LensDefocus) for cue in cues)
        tiers = [(i, t) for i, lens in enumerate(lenses) for t in range(lens.tiers)] if defocus else []
        index = torch.tensor(tiers, dtype=torch.long, device=device).reshape(-1, 2)
        self.lens, self.tier = index.unbind(-1)
        self.plain = tiers == [(i, 0) for i in range(len(lenses))]
        """Whether every lens measures with its first tier alone, so that nothing has to be picked out."""
        noise = [lenses[i].blur_noise / (2 * lenses[i].focal_length) for i, _ in tiers]
        self.slope_times_radius = torch.tensor(noise, dtype=torch.float64, device=device)

    def __call__(self, layout: Layout) -> tuple[Float[Tensor, "*batch"], Slopes]:
        """Give the score, mm^2, and its derivatives; all in float64."""
        position, radius, focus = layout.position.double(), layout.aperture_radius.double(), layout.focus.double()
        on_radius, on_focus = (radius, focus[..., 0]) if self.plain else self._picked(radius, focus)
        slope = self.slope_times_radius / on_radius
        away = position[..., self.first, :] - position[..., self.second, :]
        distance = away.norm(dim=-1).clamp_(min=NANOMETRE)
        if len(self.first):
            gain, best = (self.noise / distance).min(-1)
        else:
            gain, best = position.new_full(position.shape[:-2], inf), None
        value, by_gain, by_slope, by_focus = mean_least_square(gain, slope, on_focus, self.moments)
        by_position = torch.zeros_like(position)
        if best is not None:
            chosen = best.unsqueeze(-1)
            # d gain / d position of the first of the pair: -gain / distance^2 times the way between them.
            strength = by_gain * gain / distance.gather(-1, chosen).squeeze(-1).square()
            force = strength.view(*strength.shape, 1, 1) * away.gather(
                -2, chosen.unsqueeze(-1).expand(*away.shape[:-2], 1, 2)
            )
            by_position.scatter_(-2, self.first[chosen].unsqueeze(-1).expand_as(force), -force)
            by_position.scatter_(-2, self.second[chosen].unsqueeze(-1).expand_as(force), force)
        by_radius = -by_slope * slope / on_radius
        if self.plain:
            return value, (by_position, by_radius, _beside_others(by_focus, focus))
        spread = torch.zeros_like(focus)
        spread[..., self.lens, self.tier] = by_focus
        return value, (by_position, torch.zeros_like(radius).index_add_(-1, self.lens, by_radius), spread)

    def gain_and_slope(self, layout: Layout) -> tuple[Float[Tensor, "*batch"], Float[Tensor, "*batch k"]]:
        """Give the error of the best pair over Z^2, infinite without pairs, and h of every V, its error over Z abs(Z - Zf)."""
        position, radius = layout.position.double(), layout.aperture_radius.double()
        slope = self.slope_times_radius / (radius if self.plain else radius[..., self.lens])
        if not len(self.first):
            return position.new_full(position.shape[:-2], inf), slope
        distance = (position[..., self.first, :] - position[..., self.second, :]).norm(dim=-1)
        return (self.noise / distance.clamp(min=NANOMETRE)).amin(-1), slope

    def _picked(self, radius: Tensor, focus: Tensor) -> tuple[Tensor, Tensor]:
        return radius[..., self.lens], focus[..., self.lens, self.tier]


def differentiable(closed_form: ClosedForm, layout: Layout) -> Float[Tensor, "*batch"]:
    """Give the score as autograd wants it, in the type of the layout."""
    return _Score.apply(layout.position, layout.aperture_radius, layout.focus, closed_form)  # type: ignore[return-value]


class _Score(Function):
    @staticmethod
    def forward(ctx: Any, position: Tensor, radius: Tensor, focus: Tensor, closed_form: ClosedForm) -> Tensor:
        value, slopes = closed_form(Layout(position, radius, focus))
        ctx.save_for_backward(*(slope.to(position.dtype) for slope in slopes))
        return value.to(position.dtype)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, Tensor, Tensor, None]:  # type: ignore[override]
        by_position, by_radius, by_focus = ctx.saved_tensors
        each = grad.unsqueeze(-1)
        return each.unsqueeze(-1) * by_position, each * by_radius, each.unsqueeze(-1) * by_focus, None


def _beside_others(by_focus: Tensor, focus: Tensor) -> Tensor:
    """Give the derivative with respect to the first tier beside zeros for tiers that nothing measures with."""
    if focus.shape[-1] == 1:
        return by_focus.unsqueeze(-1)
    return torch.nn.functional.pad(by_focus.unsqueeze(-1), (0, focus.shape[-1] - 1))
