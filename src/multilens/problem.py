"""The question of a depth sensor: where, with which lenses, for which depths, and how an answer is scored."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.back import Back
from multilens.closed_form import ClosedForm, differentiable
from multilens.cues import Cue, LensDefocus, LimitedCue, Measurement, PairStereo
from multilens.envelope import DepthMoments
from multilens.field_of_view import Field, Part
from multilens.fusion import Best, Fusion
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.metrics import MeanSquare, Metric
from multilens.question import refuse_unless_lenses_and_gap
from multilens.ranges import refuse_unless_positive


@dataclass(frozen=True, eq=False)
class Problem:
    """Measure depth best: the least score, which a metric makes of the errors at all depths, and a fusion of what measures each.

    As it is, that is the weighted mean over the depths of the squared error of the best cue at each.

    Args:
        back: where lenses may stand.
        lenses: what is known of each, at least one.
        depths: where depth is to be measured, mm, > 0; `linear_depths` and `log_depths` make them.
        weights: how much each depth counts, >= 0, any scale; None counts all alike.
        cues: ways to measure depth, at least one.
        gap: distance that the lenses' bodies keep from each other, mm, >= 0.
        metric: which error of all depths counts.
        fusion: how the measurements of one depth become one error.
        guess: standard deviation of what is known of a depth before it is measured, mm, > 0: see `prior_error`. None takes the
            spread of the depths where a cue may fail, and nothing where none does.
        field: angles from straight ahead at which each depth is to be measured too, by those lenses that see there; None asks
            straight ahead alone.

    Raises:
        ValueError: something is missing, of the wrong length or out of its range.
    """

    back: Back
    lenses: tuple[Lens, ...]
    depths: Float[Tensor, " z"]
    weights: Float[Tensor, " z"]
    cues: tuple[Cue, ...]
    gap: float
    metric: Metric
    fusion: Fusion
    guess: float | None
    field: Field | None

    def __init__(
        self,
        back: Back,
        lenses: Sequence[Lens],
        depths: Tensor | Sequence[float],
        weights: Tensor | Sequence[float] | None = None,
        cues: Sequence[Cue] = (PairStereo(), LensDefocus()),
        gap: float = 0.0,
        metric: Metric = MeanSquare(),
        fusion: Fusion = Best(),
        guess: float | None = None,
        field: Field | None = None,
    ) -> None:
        depths = torch.as_tensor(depths, dtype=torch.float64)
        weights = torch.ones_like(depths) if weights is None else torch.as_tensor(weights, dtype=torch.float64)
        refuse_unless_lenses_and_gap(lenses, gap)
        if depths.ndim != 1 or not (depths.isfinite() & (depths > 0)).all() or not len(depths):
            raise ValueError("depths must be one row of finite numbers > 0 mm")
        refuse_unless_positive("nearest depth", depths.min().item())
        refuse_unless_positive("farthest depth", depths.max().item())
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
        object.__setattr__(self, "metric", metric)
        object.__setattr__(self, "fusion", fusion)
        object.__setattr__(self, "guess", None if guess is None else float(guess))
        object.__setattr__(self, "field", field)

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm: its own, or else what it reaches of the range of the depths."""
        near, far = self.depths.min().item(), self.depths.max().item()
        nearest = [lens.near_focus or 0.0 for lens in self.lenses]
        return tuple(
            lens.focus or (max(near, least), max(far, least)) for lens, least in zip(self.lenses, nearest, strict=True)
        )

    @property
    def measurements(self) -> tuple[Measurement, ...]:
        """What can be measured, in the order of the errors' k."""
        return tuple(measurement for cue in self.cues for measurement in cue.measurements(self.lenses))

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Which lenses see which share of the field: all see what lies straight ahead."""
        everyone = Part(tuple(range(len(self.lenses))), 1.0)
        return (everyone,) if self.field is None else self.field.parts(self.lenses)

    @cached_property
    def prior_error(self) -> float | None:
        """Error of a depth that nothing measures, mm; None where there is none and no guess is given.

        Unless it is given, it is the standard deviation of the depths: the error of one who knows them and always says their
        mean. A single depth has none; what is not measured is then wrong by the depth itself.
        """
        limited = any(isinstance(cue, LimitedCue) for cue in self.cues)
        if self.guess is not None or not (limited or any(not self._measures(part) for part in self.parts)):
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
        """Give the share of the depths and of the field, by weight, at which anything measures."""
        failed, weights = self.errors(layout).isinf(), self.weights.to(layout.position)
        lenses = [set(measurement.lenses) for measurement in self.measurements]
        shares = []
        for part in self.parts:
            seen = [k for k, own in enumerate(lenses) if own <= set(part.lenses)]
            shares.append(part.share * (failed[..., seen, :].all(-2) * weights).sum(-1))
        # What is missing is added up, so that nothing missing is 1 exactly.
        return 1 - torch.stack(shares).sum(0)

    @cached_property
    def score_weights(self) -> Float[Tensor, " z"]:
        """What the squared error at each depth counts for in the score: its weight times the metric's factor."""
        return self.weights * self.metric.factor(self.depths)

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give J, the mean over the depths of the square of the least error, or what the metric and the fusion make of the errors.

        In closed form for the cues of the thesis (`multilens.envelope`), else over all depths; both agree up to rounding.
        """
        if not self.has_closed_form:
            return self.score_over_depths(layout)
        self._refuse_other_lenses(layout)
        return differentiable(self.closed_form(layout.position.device), layout)

    def score_over_depths(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the score by the error of every cue at every depth, as any cue allows."""
        return self._weighted(self._by_part(layout)).amax(-1)

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give what a search minimises the largest of: the score, or the worst case depth by depth.

        Where cues may fail it is that of their smooth errors. Each is never less than what is claimed of it, yet may be less than
        the guess that is claimed where nothing measures: see docs/search.md.
        """
        if self.has_closed_form:
            return self.score(layout).unsqueeze(-1)
        return self._weighted(self._by_part(layout, smooth=True))

    def mean_square(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the weighted mean of the squared error, mm^2, whichever metric the score has."""
        if isinstance(self.metric, MeanSquare):
            return self.score(layout)
        return (self.squared_error(layout) * self.weights.to(layout.position)).sum(-1)

    def squared_error(
        self, layout: Layout, depths: Float[Tensor, " m"] | None = None, smooth: bool = False
    ) -> Float[Tensor, "*batch m"]:
        """Give the square of the one error at each depth, of all that measures it and what is known before, mm^2.

        It is the mean over the field, where one is asked for.

        Args:
            layout: one or a batch, of this problem's lenses.
            depths: mm, > 0; None takes the problem's.
            smooth: whether a search asks; else it is what may be claimed.
        """
        squares = self._by_part(layout, depths, smooth)
        return (squares * self._shares(squares)).sum(-2)

    @cached_property
    def is_envelope(self) -> bool:
        """Whether at every depth the best of the thesis' cues counts, so that, divided by the depth, errors are a line and Vs."""
        kinds = [type(cue) for cue in self.cues]
        known = set(kinds) <= {PairStereo, LensDefocus} and len(kinds) == len(set(kinds))
        return known and isinstance(self.fusion, Best) and self.guess is None and self.field is None

    @cached_property
    def has_closed_form(self) -> bool:
        """Whether the score is a sum over the depths of such errors: then there is a closed form, and a bound."""
        return self.is_envelope and self.metric.is_mean

    def closed_form(self, device: torch.device) -> ClosedForm:
        """Give the score with its gradient at once, where `has_closed_form`; its line and Vs also where it `is_envelope`."""
        if device not in self._closed_forms:
            moments = DepthMoments(self.depths, self.score_weights).to(device)
            self._closed_forms[device] = ClosedForm(self.lenses, self.cues, moments)
        return self._closed_forms[device]

    @cached_property
    def _closed_forms(self) -> dict[torch.device, ClosedForm]:
        return {}

    def _by_part(
        self, layout: Layout, depths: Float[Tensor, " z"] | None = None, smooth: bool = False
    ) -> Float[Tensor, "*batch g z"]:
        """Give the squared error at each depth in each part of the field, by the lenses that see it alone."""
        self._refuse_other_lenses(layout)
        depths = (self.depths if depths is None else depths).to(layout.position)
        squares = []
        for part in self.parts:
            if self._measures(part):
                lenses = [self.lenses[index] for index in part.lenses]
                square = self.fusion.squared_error(self.cues, layout.only(part.lenses), lenses, depths, smooth)
            else:
                square = depths.new_full((*layout.aperture_radius.shape[:-1], len(depths)), inf)
            squares.append(self._with_prior(square))
        return torch.stack(squares, dim=-2)

    def _measures(self, part: Part) -> bool:
        lenses = [self.lenses[index] for index in part.lenses]
        return any(cue.measurements(lenses) for cue in self.cues)

    def _shares(self, like: Tensor) -> Float[Tensor, "g 1"]:
        return like.new_tensor([part.share for part in self.parts]).unsqueeze(-1)

    def _weighted(self, squares: Float[Tensor, "*batch g z"]) -> Float[Tensor, "*batch m"]:
        """Give the terms of the score: their mean, or all of which the largest counts."""
        if self.metric.is_mean:
            return (squares * (self._shares(squares) * self.score_weights.to(squares))).sum((-2, -1)).unsqueeze(-1)
        counted = self.weights > 0
        return (squares[..., counted] * self.metric.factor(self.depths[counted]).to(squares)).flatten(-2)

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
