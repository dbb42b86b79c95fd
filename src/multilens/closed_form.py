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

CHUNK = 2048
"""Designs at once: what they need on the way stays in the cache of a core."""

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
        self.pairs = pair_indices(len(lenses) if stereo else 1, device)
        self.first, self.second = self.pairs
        if stereo:
            self.noise = stereo.noise(lenses, torch.float64).to(device)
            self.square_noise = self.noise.square().unsqueeze(-1)
            self.rank = torch.arange(len(self.first), dtype=torch.int32, device=device).unsqueeze(-1)
        defocus = any(isinstance(cue, LensDefocus) for cue in cues)
        tiers = [(i, t) for i, lens in enumerate(lenses) for t in range(lens.tiers)] if defocus else []
        index = torch.tensor(tiers, dtype=torch.long, device=device).reshape(-1, 2)
        self.lens, self.tier = index.unbind(-1)
        self.plain = tiers == [(i, 0) for i in range(len(lenses))]
        """Whether every lens measures with its first tier alone, so that nothing has to be picked out."""
        noise = [lenses[i].blur_noise / (2 * lenses[i].focal_length) for i, _ in tiers]
        self.slope_times_radius = torch.tensor(noise, dtype=torch.float64, device=device)

    @torch.no_grad()
    def __call__(self, layout: Layout) -> tuple[Float[Tensor, "*batch"], Slopes]:
        """Give the score, mm^2, and its derivatives; all in float64."""
        position, radius, focus = layout.position.double(), layout.aperture_radius.double(), layout.focus.double()
        batch = radius.shape[:-1]
        parts = (position.reshape(-1, *position.shape[-2:]), radius.reshape(-1, radius.shape[-1]))
        every = (*parts, focus.reshape(-1, *focus.shape[-2:]))
        if len(every[0]) <= CHUNK:
            value, *slopes = self._of_few(*every)
        else:
            few = [self._of_few(*some) for some in zip(*(part.split(CHUNK) for part in every), strict=True)]
            value, *slopes = (torch.cat(each) for each in zip(*few, strict=True))
        by_position, by_radius, by_focus = (each.view(*batch, *each.shape[1:]) for each in slopes)
        return value.view(batch), (by_position, by_radius, by_focus)

    def _of_few(
        self, position: Float[Tensor, "b n 2"], radius: Float[Tensor, "b n"], focus: Float[Tensor, "b n t"]
    ) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        """Give value and derivatives of some designs."""
        on_radius, on_focus = (radius, focus[..., 0]) if self.plain else self._picked(radius, focus)
        slope = self.slope_times_radius / on_radius
        gain, pair, way = self._best_pair(position)
        value, by_gain, by_slope, by_focus = mean_least_square(gain, slope, on_focus, self.moments)
        by_position = torch.zeros_like(position)
        if pair is not None:
            # d gain / d position of the first of the pair: -gain / distance^2 times the way between them.
            force = (way * (by_gain * gain / _squared_length(way))).T
            of_both = self.pairs.index_select(1, pair).T.unsqueeze(-1).expand(-1, -1, 2)
            by_position.scatter_(1, of_both, torch.stack([-force, force], dim=1))
        by_radius = by_slope.mul(slope).div_(on_radius).neg_()
        if not self.plain:
            by_radius = torch.zeros_like(radius).index_add_(1, self.lens, by_radius)
        if self.plain and focus.shape[-1] == 1:
            return value, by_position, by_radius, by_focus.unsqueeze(-1)
        spread = torch.zeros_like(focus)
        spread[:, self.lens, self.tier] = by_focus
        return value, by_position, by_radius, spread

    def _best_pair(self, position: Float[Tensor, "b n 2"]) -> tuple[Float[Tensor, " b"], Tensor | None, Tensor]:
        """Give the least gain, its pair [b] and the way from its second lens to its first [2, b]."""
        if not len(self.first):
            return position.new_full(position.shape[:1], inf), None, position
        # The batch comes last, so that every step runs along memory.
        place = position.permute(2, 1, 0).contiguous()
        way = place.index_select(1, self.first).sub_(place.index_select(1, self.second))
        square_gain = self.square_noise / _squared_length(way)
        least = square_gain.amin(0)
        # Multiplied, not searched: a search is a branch for each number.
        pair = ((square_gain == least) * self.rank).amax(0).long()
        return least.sqrt(), pair, way.gather(1, pair.expand(2, 1, -1)).squeeze(1)

    def gain_and_slope(self, layout: Layout) -> tuple[Float[Tensor, "*batch"], Float[Tensor, "*batch k"]]:
        """Give the error of the best pair over Z^2, infinite without pairs, and h of every V, its error over Z abs(Z - Zf)."""
        position, radius = layout.position.double(), layout.aperture_radius.double()
        slope = self.slope_times_radius / (radius if self.plain else radius[..., self.lens])
        if not len(self.first):
            return position.new_full(position.shape[:-2], inf), slope
        distance = (position[..., self.first, :] - position[..., self.second, :]).norm(dim=-1)
        return (self.noise / distance.clamp(min=NANOMETRE)).amin(-1), slope

    def _picked(self, radius: Float[Tensor, "b n"], focus: Float[Tensor, "b n t"]) -> tuple[Tensor, Tensor]:
        """Give radius and focus of everything that measures by defocus, [b, k]."""
        return radius[:, self.lens], focus[:, self.lens, self.tier]


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


def _squared_length(way: Float[Tensor, "2 ..."]) -> Float[Tensor, "..."]:
    return way[0].square().addcmul_(way[1], way[1]).clamp_(min=NANOMETRE**2)
