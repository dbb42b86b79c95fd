"""A cue: what can be measured at a depth, by which lenses, and how far off the measured depth will be."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from jaxtyping import Float
from torch import Tensor

from multilens.layout import Layout
from multilens.lens import Lens


@dataclass(frozen=True)
class Measurement:
    """One way to measure depth: a cue, and the lens or the two lenses it uses.

    Args:
        cue: name of the cue: stereo, defocus.
        lenses: index of each lens that takes part, from 0.
        tier: which of the lens' foci, from 0; None where the cue does not use one.
        label: how tables and pictures call it; lenses and tiers are counted from 1 there.
    """

    cue: str
    lenses: tuple[int, ...]
    tier: int | None
    label: str


@runtime_checkable
class Cue(Protocol):
    """A way to measure depth, for every lens or pair of lenses that can."""

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name each of the k measurements that these lenses allow."""
        ...

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of each measurement at each depth, mm, differentiable in the layout."""
        ...


@runtime_checkable
class FactoredCue(Cue, Protocol):
    """A cue whose measurements all depend on depth alike, err_k(Z) = gain_k shape(Z): the best of them is best everywhere.

    Then the least of k numbers stands for the least of k curves.
    """

    def gain(self, layout: Layout, lenses: Sequence[Lens]) -> Float[Tensor, "*batch k"]:
        """Give the factor of each measurement, differentiable in the layout."""
        ...

    def shape(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give the factor that they share."""
        ...


@runtime_checkable
class LimitedCue(Cue, Protocol):
    """A cue whose measurements fail at some depths: there, and there alone, its errors are infinite.

    `__call__` is what may be claimed. It jumps where a measurement begins to fail, which no gradient sees, so that the search
    follows another function.
    """

    def smooth(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give errors that are finite, differentiable and never less than those of `__call__` where these are finite."""
        ...


@runtime_checkable
class FusedCue(Cue, Protocol):
    """A cue that knows what its measurements tell together, as those of many views of one point do, which share their noise.

    Of a cue that does not say, all measurements count as independent: the sum of 1 / err^2.
    """

    def information(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch z"]:
        """Give one over the variance of the depth that all measurements give together, 1/mm^2, >= 0.

        Args:
            layout: where the lenses stand.
            lenses: what is known of each.
            depths: Z, mm, > 0.
            smooth: whether a search asks, that wants a differentiable number; else what may be claimed.
        """
        ...
