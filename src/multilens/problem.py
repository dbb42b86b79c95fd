"""The question: where, with which lenses, for which depths, and how an answer is scored."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Protocol, runtime_checkable

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.back import Back
from multilens.closed_form import ClosedForm, differentiable
from multilens.cues import Cue, FactoredCue, LensDefocus, Measurement, PairStereo
from multilens.envelope import DepthMoments
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.numerics import least


def linear_depths(near: float, far: float, count: int = 512) -> Float[Tensor, " z"]:
    """Give depths evenly spaced from near to far, both included.

    Args:
        near: mm, > 0.
        far: mm, > near.
        count: how many, >= 2.

    Raises:
        ValueError: a number is out of its range.
    """
    _refuse_unless_depth_range(near, far, count)
    return torch.linspace(near, far, count, dtype=torch.float64)


def log_depths(near: float, far: float, count: int = 512) -> Float[Tensor, " z"]:
    """Give depths from near to far, both included, each the same factor beyond the last.

    Args:
        near: mm, > 0.
        far: mm, > near.
        count: how many, >= 2.

    Raises:
        ValueError: a number is out of its range.
    """
    _refuse_unless_depth_range(near, far, count)
    depths = near * (far / near) ** torch.linspace(0, 1, count, dtype=torch.float64)
    # Rounding would put the ends beside what was asked for.
    depths[0], depths[-1] = near, far
    return depths


@runtime_checkable
class Question(Protocol):
    """What the search needs to know: the constraints, and the score as a differentiable function of the layout."""

    @property
    def back(self) -> Back:
        """Where lenses may stand."""
        ...

    @property
    def lenses(self) -> tuple[Lens, ...]:
        """What is known of each lens."""
        ...

    @property
    def gap(self) -> float:
        """Distance that bodies keep from each other, mm."""
        ...

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm."""
        ...

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give the numbers of which the largest is the score, differentiable by autograd."""
        ...


@dataclass(frozen=True, eq=False)
class Problem:
    """Measure depth best: the weighted mean over the depths of the squared error of the best cue at each.

    Args:
        back: where lenses may stand.
        lenses: what is known of each, at least one.
        depths: where depth is to be measured, mm, > 0; `linear_depths` and `log_depths` make them.
        weights: how much each depth counts, >= 0, any scale; None counts all alike.
        cues: ways to measure depth, at least one.
        gap: distance that the lenses' bodies keep from each other, mm, >= 0.

    Raises:
        ValueError: something is missing, of the wrong length or out of its range.
    """

    back: Back
    lenses: tuple[Lens, ...]
    depths: Float[Tensor, " z"]
    weights: Float[Tensor, " z"]
    cues: tuple[Cue, ...]
    gap: float

    def __init__(
        self,
        back: Back,
        lenses: Sequence[Lens],
        depths: Tensor | Sequence[float],
        weights: Tensor | Sequence[float] | None = None,
        cues: Sequence[Cue] = (PairStereo(), LensDefocus()),
        gap: float = 0.0,
    ) -> None:
        depths = torch.as_tensor(depths, dtype=torch.float64)
        weights = torch.ones_like(depths) if weights is None else torch.as_tensor(weights, dtype=torch.float64)
        _refuse_unless_lenses_and_gap(lenses, gap)
        if depths.ndim != 1 or not (depths.isfinite() & (depths > 0)).all() or not len(depths):
            raise ValueError("depths must be one row of finite numbers > 0 mm")
        if weights.shape != depths.shape or not (weights.isfinite() & (weights >= 0)).all() or not weights.sum() > 0:
            raise ValueError(f"weights must be {len(depths)} finite numbers >= 0, not all 0, one for each depth")
        if not sum(len(cue.measurements(lenses)) for cue in cues):
            raise ValueError("cues must give at least one measurement with these lenses, got none")
        object.__setattr__(self, "back", back)
        object.__setattr__(self, "lenses", tuple(lenses))
        object.__setattr__(self, "depths", depths)
        # Weights that are shares already stay as they are to the bit, so that a problem read back from a file is the same one.
        shares = weights if abs(weights.sum().item() - 1) < 1e-12 else weights / weights.sum()
        object.__setattr__(self, "weights", shares)
        object.__setattr__(self, "cues", tuple(cues))
        object.__setattr__(self, "gap", float(gap))

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm: its own, or else the range of the depths."""
        whole = (self.depths.min().item(), self.depths.max().item())
        return tuple(lens.focus or whole for lens in self.lenses)

    @property
    def measurements(self) -> tuple[Measurement, ...]:
        """What can be measured, in the order of the errors' k."""
        return tuple(measurement for cue in self.cues for measurement in cue.measurements(self.lenses))

    def errors(self, layout: Layout) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every measurement at every depth, mm."""
        self._refuse_other_lenses(layout)
        depths = self.depths.to(layout.position)
        return torch.cat([cue(layout, self.lenses, depths) for cue in self.cues], dim=-2)

    def winners(self, layout: Layout) -> Int[Tensor, "*batch z"]:
        """Give the index of the measurement that is best at each depth; the first of equals."""
        return self.errors(layout).argmin(-2)

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give J, the weighted mean over the depths of the square of the least error, mm^2.

        In closed form for the cues of the thesis (`multilens.envelope`), else over all depths; both agree up to rounding.
        """
        if not self.is_envelope:
            return self.score_over_depths(layout)
        self._refuse_other_lenses(layout)
        return differentiable(self.closed_form(layout.position.device), layout)

    def score_over_depths(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the score by the error of every cue at every depth, as any cue allows; pairs of a factored cue count as one."""
        return self._mean(least(self._squares(layout)))

    @cached_property
    def is_envelope(self) -> bool:
        """Whether the cues are the thesis' alone, each at most once, so that the score has a closed form."""
        kinds = [type(cue) for cue in self.cues]
        return set(kinds) <= {PairStereo, LensDefocus} and len(kinds) == len(set(kinds))

    def closed_form(self, device: torch.device) -> ClosedForm:
        """Give the score with its gradient as one function; only for the thesis' cues, `is_envelope`."""
        if device not in self._closed_forms:
            moments = DepthMoments(self.depths, self.weights).to(device)
            self._closed_forms[device] = ClosedForm(self.lenses, self.cues, moments)
        return self._closed_forms[device]

    @cached_property
    def _closed_forms(self) -> dict[torch.device, ClosedForm]:
        return {}

    def terms(self, layout: Layout) -> Float[Tensor, "*batch 1"]:
        """Give the score alone."""
        return self.score(layout).unsqueeze(-1)

    def _squares(self, layout: Layout) -> Float[Tensor, "*batch c z"]:
        """Give the squared errors; of a factored cue only the least, one curve for all its measurements."""
        self._refuse_other_lenses(layout)
        depths = self.depths.to(layout.position)
        squares = []
        for cue in self.cues:
            if not cue.measurements(self.lenses):
                continue
            if isinstance(cue, FactoredCue):
                gain = cue.gain(layout, self.lenses).amin(-1, keepdim=True)
                squares.append((gain * cue.shape(depths)).square().unsqueeze(-2))
            else:
                squares.append(cue(layout, self.lenses, depths).square())
        return torch.cat(squares, dim=-2)

    def _refuse_other_lenses(self, layout: Layout) -> None:
        tiers = max(lens.tiers for lens in self.lenses)
        if layout.count != len(self.lenses) or layout.focus.shape[-1] < tiers:
            raise ValueError(
                f"layout must have {len(self.lenses)} lenses of {tiers} foci, the problem's, "
                f"got {layout.count} of {layout.focus.shape[-1]}"
            )

    def _mean(self, squared_error: Float[Tensor, "*batch z"]) -> Float[Tensor, "*batch"]:
        return (squared_error * self.weights.to(squared_error)).sum(-1)


@dataclass(frozen=True, eq=False)
class ScoreProblem:
    """Any score that can be computed from a layout, under the same constraints.

    The largest circles that fit a square, for one, are `score=lambda layout: -layout.aperture_radius`: of several numbers the
    largest counts, and it is minimised.

    Args:
        back: where lenses may stand.
        lenses: what is known of each, at least one; a lens without bounds of focus has the focus 1 mm.
        score: from a batch of layouts to a tensor [*batch] or [*batch, m], differentiable by autograd; less is better.
        gap: distance that the lenses' bodies keep from each other, mm, >= 0.
    """

    back: Back
    lenses: tuple[Lens, ...]
    function: Callable[[Layout], Tensor]
    gap: float

    def __init__(self, back: Back, lenses: Sequence[Lens], score: Callable[[Layout], Tensor], gap: float = 0.0) -> None:
        _refuse_unless_lenses_and_gap(lenses, gap)
        object.__setattr__(self, "back", back)
        object.__setattr__(self, "lenses", tuple(lenses))
        object.__setattr__(self, "function", score)
        object.__setattr__(self, "gap", float(gap))

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm."""
        return tuple(lens.focus or (1.0, 1.0) for lens in self.lenses)

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give the numbers of which the largest is the score."""
        terms = self.function(layout)
        return terms.unsqueeze(-1) if terms.ndim == layout.aperture_radius.ndim - 1 else terms

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the largest of the terms."""
        return self.terms(layout).amax(-1)


def _refuse_unless_depth_range(near: float, far: float, count: int) -> None:
    if not (isfinite(near) and near > 0):
        raise ValueError(f"near must be > 0 mm and finite, got {near:g}")
    if not (isfinite(far) and far > near):
        raise ValueError(f"far must be > near = {near:g} mm and finite, got {far:g}")
    if not isinstance(count, int) or count < 2:
        raise ValueError(f"count must be a whole number >= 2, got {count}")


def _refuse_unless_lenses_and_gap(lenses: Sequence[Lens], gap: float) -> None:
    if not lenses:
        raise ValueError("lenses must be at least one, got none")
    if not isfinite(gap) or gap < 0:
        raise ValueError(f"gap must be >= 0 mm and finite, got {gap:g}")
