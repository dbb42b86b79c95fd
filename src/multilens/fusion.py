"""Fusion: how the measurements of one depth become one error."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Protocol, runtime_checkable

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.cues import NANOMETRE, Cue, FactoredCue, FusedCue, LimitedCue
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.numerics import least


@runtime_checkable
class Fusion(Protocol):
    """A way to make one error of many measurements."""

    def squared_error(
        self,
        cues: Sequence[Cue],
        layout: Layout,
        lenses: Sequence[Lens],
        depths: Float[Tensor, " z"],
        smooth: bool = False,
    ) -> Float[Tensor, "*batch z"]:
        """Give the square of the one error at each depth, mm^2, infinite where nothing measures.

        Args:
            cues: ways to measure depth, with at least one measurement among them.
            layout: where the lenses stand.
            lenses: what is known of each.
            depths: Z, mm, > 0.
            smooth: whether a search asks, which follows the smooth errors of cues that may fail; else what may be claimed.
        """
        ...


@dataclass(frozen=True)
class Best:
    """The best measurement at each depth, and no other: err = min_k err_k.

    Reference:
        Thesis, chapter 6.
    """

    def squared_error(
        self,
        cues: Sequence[Cue],
        layout: Layout,
        lenses: Sequence[Lens],
        depths: Float[Tensor, " z"],
        smooth: bool = False,
    ) -> Float[Tensor, "*batch z"]:
        """Give the least squared error; of a factored cue one curve stands for all its measurements."""
        squares = []
        for cue in cues:
            if not cue.measurements(lenses):
                continue
            if isinstance(cue, FactoredCue):
                gain = cue.gain(layout, lenses).amin(-1, keepdim=True)
                squares.append((gain * cue.shape(depths)).square().unsqueeze(-2))
            else:
                squares.append(_errors(cue, layout, lenses, depths, smooth).square())
        return least(torch.cat(squares, dim=-2))


@dataclass(frozen=True)
class InverseVariance:
    """All measurements together, each weighted by one over its variance: 1 / err^2 = sum of what they tell.

    Lenses that see one point in stereo count as views of it, not as pairs that would be independent; cues count as independent
    of each other. An error below a nanometre tells no more than one of a nanometre.

    Reference:
        docs/metrics.md, "Many views of one point".
    """

    def squared_error(
        self,
        cues: Sequence[Cue],
        layout: Layout,
        lenses: Sequence[Lens],
        depths: Float[Tensor, " z"],
        smooth: bool = False,
    ) -> Float[Tensor, "*batch z"]:
        """Give one over the sum of what each cue tells."""
        each = [_information(cue, layout, lenses, depths, smooth) for cue in cues if cue.measurements(lenses)]
        told = torch.stack(torch.broadcast_tensors(*each)).sum(0)
        # The gradient of one over nothing is NaN even where it is not used, and squares what it divides by.
        least = torch.finfo(told.dtype).tiny ** 0.5
        return (1 / told.clamp(least, 1 / NANOMETRE**2)).where(told > 0, inf)


def _information(cue: Cue, layout: Layout, lenses: Sequence[Lens], depths: Tensor, smooth: bool) -> Tensor:
    if isinstance(cue, FusedCue):
        return cue.information(layout, lenses, depths, smooth)
    # In focus the thesis' defocus has no error; held to a nanometre its gradient is 0 there, not NaN.
    return _errors(cue, layout, lenses, depths, smooth).clamp(min=NANOMETRE).square().reciprocal().sum(-2)


def _errors(cue: Cue, layout: Layout, lenses: Sequence[Lens], depths: Tensor, smooth: bool) -> Tensor:
    return cue.smooth(layout, lenses, depths) if smooth and isinstance(cue, LimitedCue) else cue(layout, lenses, depths)


FUSIONS = {"best": Best, "inverse_variance": InverseVariance}
"""Every fusion that a file or a command line may name."""
