"""The question of a depth sensor: where, with which lenses, for which depths, and how an answer is scored."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.back import Back
from multilens.closed_form import ClosedForm, differentiable
from multilens.cues import Cue, FactoredCue, LensDefocus, LimitedCue, Measurement, PairStereo
from multilens.envelope import DepthMoments
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.numerics import least
from multilens.question import refuse_unless_lenses_and_gap


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
        guess: standard deviation of what is known of a depth before it is measured, mm, > 0: see `prior_error`. None takes the
            spread of the depths where a cue may fail, and nothing where none does.

    Raises:
        ValueError: something is missing, of the wrong length or out of its range.
    """

    back: Back
    lenses: tuple[Lens, ...]
    depths: Float[Tensor, " z"]
    weights: Float[Tensor, " z"]
    cues: tuple[Cue, ...]
    gap: float
    guess: float | None

    def __init__(
        self,
        back: Back,
        lenses: Sequence[Lens],
        depths: Tensor | Sequence[float],
        weights: Tensor | Sequence[float] | None = None,
        cues: Sequence[Cue] = (PairStereo(), LensDefocus()),
        gap: float = 0.0,
        guess: float | None = None,
    ) -> None:
        depths = torch.as_tensor(depths, dtype=torch.float64)
        weights = torch.ones_like(depths) if weights is None else torch.as_tensor(weights, dtype=torch.float64)
        refuse_unless_lenses_and_gap(lenses, gap)
        if depths.ndim != 1 or not (depths.isfinite() & (depths > 0)).all() or not len(depths):
            raise ValueError("depths must be one row of finite numbers > 0 mm")
        if weights.shape != depths.shape or not (weights.isfinite() & (weights >= 0)).all() or not weights.sum() > 0:
            raise ValueError(f"weights must be {len(depths)} finite numbers >= 0, not all 0, one for each depth")
        if not sum(len(cue.measurements(lenses)) for cue in cues):
            raise ValueError("cues must give at least one measurement with these lenses, got none")
        if guess is not None and not (isfinite(guess) and guess > 0):
            raise ValueError(f"guess must be > 0 mm and finite, got {guess:g}")
        object.__setattr__(self, "back", back)
        object.__setattr__(self, "lenses", tuple(lenses))
        object.__setattr__(self, "depths", depths)
        # Weights that are shares already stay as they are to the bit, so that a problem read back from a file is the same one.
        shares = weights if abs(weights.sum().item() - 1) < 1e-12 else weights / weights.sum()
        object.__setattr__(self, "weights", shares)
        object.__setattr__(self, "cues", tuple(cues))
        object.__setattr__(self, "gap", float(gap))
        object.__setattr__(self, "guess", guess)

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm: its own, or else the range of the depths."""
        whole = (self.depths.min().item(), self.depths.max().item())
        return tuple(lens.focus or whole for lens in self.lenses)

    @property
    def measurements(self) -> tuple[Measurement, ...]:
        """What can be measured, in the order of the errors' k."""
        return tuple(measurement for cue in self.cues for measurement in cue.measurements(self.lenses))

    @cached_property
    def prior_error(self) -> float | None:
        """Error of a depth that nothing measures, mm; None where no cue can fail and no guess is given.

        Unless it is given, it is the standard deviation of the depths: the error of one who knows them and always says their
        mean. A single depth has none; what is not measured is then wrong by the depth itself.
        """
        if self.guess is not None or not any(isinstance(cue, LimitedCue) for cue in self.cues):
            return self.guess
        mean = (self.weights * self.depths).sum()
        spread = (self.weights * (self.depths - mean).square()).sum().sqrt()
        return spread.item() if spread > 0 else mean.item()

    def errors(self, layout: Layout) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every measurement at every depth, mm; infinite where a measurement fails."""
        self._refuse_other_lenses(layout)
        depths = self.depths.to(layout.position)
        return torch.cat([cue(layout, self.lenses, depths) for cue in self.cues], dim=-2)

    def winners(self, layout: Layout) -> Int[Tensor, "*batch z"]:
        """Give the index of the measurement that is best at each depth; the first of equals."""
        return self.errors(layout).argmin(-2)

    def measured(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the share of the depths, by weight, at which anything measures."""
        return self._mean(self.errors(layout).isfinite().any(-2).to(layout.position))

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
        return self._mean(self._with_prior(least(self._squares(layout, smooth=False))))

    def terms(self, layout: Layout) -> Float[Tensor, "*batch 1"]:
        """Give what a search minimises: the score, of smooth errors where cues may fail, which are never less."""
        if self.is_smooth:
            return self.score(layout).unsqueeze(-1)
        return self._mean(self._with_prior(least(self._squares(layout, smooth=True)))).unsqueeze(-1)

    @cached_property
    def is_envelope(self) -> bool:
        """Whether the cues are the thesis' alone, each at most once, so that the score has a closed form."""
        kinds = [type(cue) for cue in self.cues]
        return set(kinds) <= {PairStereo, LensDefocus} and len(kinds) == len(set(kinds)) and self.guess is None

    @cached_property
    def is_smooth(self) -> bool:
        """Whether no cue may fail, so that the score itself can be minimised."""
        return not any(isinstance(cue, LimitedCue) for cue in self.cues)

    def closed_form(self, device: torch.device) -> ClosedForm:
        """Give the score with its gradient as one function; only for the thesis' cues, `is_envelope`."""
        if device not in self._closed_forms:
            moments = DepthMoments(self.depths, self.weights).to(device)
            self._closed_forms[device] = ClosedForm(self.lenses, self.cues, moments)
        return self._closed_forms[device]

    @cached_property
    def _closed_forms(self) -> dict[torch.device, ClosedForm]:
        return {}

    def _squares(self, layout: Layout, smooth: bool) -> Float[Tensor, "*batch c z"]:
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
            elif smooth and isinstance(cue, LimitedCue):
                squares.append(cue.smooth(layout, self.lenses, depths).square())
            else:
                squares.append(cue(layout, self.lenses, depths).square())
        return torch.cat(squares, dim=-2)

    def _with_prior(self, square: Float[Tensor, "*batch z"]) -> Float[Tensor, "*batch z"]:
        """Give the squared error of measurement and guess together, 1 / (1/e^2 + 1/g^2)."""
        if self.prior_error is None:
            return square
        prior = self.prior_error**2
        # An infinite error would make the gradient NaN even where it is not used.
        known = square.isfinite()
        finite = square.where(known, 0)
        return torch.where(known, finite / (1 + finite / prior), prior)

    def _refuse_other_lenses(self, layout: Layout) -> None:
        tiers = max(lens.tiers for lens in self.lenses)
        if layout.count != len(self.lenses) or layout.focus.shape[-1] < tiers:
            raise ValueError(
                f"layout must have {len(self.lenses)} lenses of {tiers} foci, the problem's, "
                f"got {layout.count} of {layout.focus.shape[-1]}"
            )

    def _mean(self, values: Float[Tensor, "*batch z"]) -> Float[Tensor, "*batch"]:
        return (values * self.weights.to(values)).sum(-1)
