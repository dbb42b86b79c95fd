"""A problem asked of the devices that will be built and used, not of the one that is drawn."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.back import Back
from multilens.cues.drift import drifted
from multilens.disturbance import Devices, Disturbance, draw_devices
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.metrics import Metric
from multilens.problem import Problem
from multilens.question import Question
from multilens.tail import tail_mean

WORST_TOLD = 8
"""Terms that stand for all where the worst case is minimised: the others are far from being the worst."""

MOST_AT_ONCE = 2**24
"""Errors, a number for each layout, device, measurement and depth, that are computed together: 128 MB."""


@dataclass(frozen=True)
class Use:
    """One way in which a device is used: with which lenses, and how likely.

    Args:
        name: in words.
        probability: from 0 to 1.
        lenses: index of each lens that sees.
        problem: of these lenses alone.
    """

    name: str
    probability: float
    lenses: tuple[int, ...]
    problem: Problem


@dataclass(frozen=True)
class OverDevices:
    """The metric of a problem, of many devices: the root of their mean score, or of that of the worst of them.

    Args:
        of: the problem's metric.
        level: how much of the better outcomes is left out, from 0 to 1.
    """

    of: Metric
    level: float

    @property
    def name(self) -> str:
        """Say which devices count."""
        if self.level in (0, 1):
            return f"{self.of.name} over devices" if self.level == 0 else f"{self.of.name} of the worst device"
        return f"{self.of.name} of the worst {100 * (1 - self.level):.3g} % of devices"

    @property
    def unit(self) -> str:
        """Of the problem's metric."""
        return self.of.unit

    @property
    def score_unit(self) -> str:
        """Of the problem's score."""
        return self.of.score_unit

    @property
    def is_mean(self) -> bool:
        """Say that it is no sum over the depths of one device's errors."""
        return False

    def factor(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give what the squared error at each depth is multiplied by."""
        return self.of.factor(depths)

    def figure(self, score: float) -> float:
        """Turn a score into the number that people quote."""
        return self.of.figure(score)


@dataclass(frozen=True, eq=False)
class Robust:
    """Measure depth best on devices that are not quite as drawn: the mean of the problem's score over the worst of them.

    The devices are drawn once and are the same for every layout, so that layouts are compared under the same mishaps and the score
    is a differentiable function. What a search finds suits its own sample a little better than others; `afresh` draws others.

    Args:
        problem: what a device is to do.
        disturbance: how far off devices are.
        level: how much of the better outcomes is left out, from 0 to 1: 0 counts the mean of all, 0.9 that of the worst tenth, 1
            the worst.
        samples: how many devices are drawn, even, >= 2.
        seed: of the devices.

    Raises:
        ValueError: a number is out of its range, or with a lens covered nothing measures.

    Reference:
        docs/robustness.md.
    """

    problem: Problem
    disturbance: Disturbance
    level: float = 0.0
    samples: int = 64
    seed: int = 0

    def __post_init__(self) -> None:
        if not 0 <= self.level <= 1:
            raise ValueError(f"level must be from 0 to 1, got {self.level:g}")
        if self.samples < 2 or self.samples % 2:
            raise ValueError(f"samples must be an even number >= 2, got {self.samples}")
        if not 0 <= self.seed < 2**31:
            raise ValueError(f"seed must be from 0 to 2147483647, got {self.seed}")
        # A lens that nothing can do without is told of now, not in the middle of a search.
        _ = self.uses

    @property
    def back(self) -> Back:
        """Where lenses may stand, as they are drawn."""
        return self.problem.back

    @property
    def lenses(self) -> tuple[Lens, ...]:
        """What is known of each lens."""
        return self.problem.lenses

    @property
    def gap(self) -> float:
        """Distance that bodies keep from each other as they are drawn, mm."""
        return self.problem.gap

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens as it is drawn, mm."""
        return self.problem.focus_range

    @property
    def metric(self) -> OverDevices:
        """What the score is called and its unit: the problem's, of many devices."""
        return OverDevices(self.problem.metric, self.level)

    @cached_property
    def drawn(self) -> Problem:
        """The problem of a device as it is drawn, drift included, with no lens covered."""
        cues = [drifted(cue, self.disturbance.drift) for cue in self.problem.cues]
        return replace(self.problem, cues=cues)

    @cached_property
    def devices(self) -> Devices:
        """The sample of devices."""
        return draw_devices(self.disturbance, len(self.lenses), self.samples, self.seed)

    @cached_property
    def uses(self) -> tuple[Use, ...]:
        """The ways in which a device is used that can happen: all lenses free, or one of them covered."""
        count, covered = len(self.lenses), self.disturbance.covered
        every = tuple(range(count))
        ways = [Use("no lens covered", 1 - covered, every, self.drawn)] if covered < 1 else []
        if covered > 0:
            kept = [tuple(j for j in every if j != i) for i in every]
            ways += [Use(f"lens {i + 1} covered", covered / count, kept[i], without(self.drawn, i)) for i in every]
        return tuple(ways)

    def afresh(self, seed: int, samples: int | None = None) -> "Robust":
        """Ask the same of other devices.

        Args:
            seed: of them.
            samples: how many; None for as many as here.
        """
        return replace(self, seed=seed, samples=self.samples if samples is None else samples)

    def outcomes(self, layout: Layout) -> tuple[Float[Tensor, "*batch o"], Float[Tensor, " o"]]:
        """Give the problem's score of every device in every use, and the probability of each."""
        with_devices = self.devices.built(layout)
        scores = torch.stack([_score(use, with_devices) for use in self.uses], dim=-1)
        return scores.flatten(-2), self._probability

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the mean of the worst outcomes, in the unit of the problem's score."""
        return tail_mean(*self.outcomes(layout), self.level)

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give what a search minimises the largest of: the score by smooth errors, or the few worst outcomes at level 1."""
        with_devices = self.devices.built(layout)
        terms = [_terms(use, with_devices) for use in self.uses]
        if self.level == 1:
            every = torch.cat([each.flatten(-2) for each in terms], dim=-1)
            return every.topk(min(WORST_TOLD, every.shape[-1]), dim=-1).values
        outcomes = torch.stack([each.amax(-1) for each in terms], dim=-1).flatten(-2)
        return tail_mean(outcomes, self._probability, self.level).unsqueeze(-1)

    @cached_property
    def _probability(self) -> Float[Tensor, " o"]:
        ways = torch.tensor([use.probability for use in self.uses], dtype=torch.float64)
        devices = len(self.devices.shift)
        return (ways / devices).expand(devices, -1).flatten()


def as_drawn(question: Question) -> Question:
    """Give the problem of a device as it is drawn where a question is asked of many devices; any other question as it is."""
    return question.drawn if isinstance(question, Robust) else question


def without(problem: Problem, covered: int) -> Problem:
    """Give a problem whose lens of an index is covered: all that it takes part in is gone.

    Raises:
        ValueError: nothing is left that measures.
    """
    lenses = [lens for i, lens in enumerate(problem.lenses) if i != covered]
    if not lenses or not any(cue.measurements(lenses) for cue in problem.cues):
        raise ValueError(f"lens {covered + 1} cannot be covered: without it nothing measures")
    return replace(problem, lenses=lenses)


def _score(use: Use, layout: Layout) -> Float[Tensor, "*batch"]:
    return torch.cat([use.problem.score(part) for part in _parts(use, layout)]).unflatten(0, layout.position.shape[:-2])


def _terms(use: Use, layout: Layout) -> Float[Tensor, "*batch m"]:
    return torch.cat([use.problem.terms(part) for part in _parts(use, layout)]).unflatten(0, layout.position.shape[:-2])


def _parts(use: Use, layout: Layout) -> Iterator[Layout]:
    """Give the lenses in use of all layouts, as many at once as memory should hold."""
    seeing = layout.only(use.lenses)
    flat = Layout(seeing.position.flatten(0, -3), seeing.aperture_radius.flatten(0, -2), seeing.focus.flatten(0, -3))
    most = max(1, MOST_AT_ONCE // (len(use.problem.measurements) * len(use.problem.depths)))
    for start in range(0, len(flat.position), most):
        yield flat[start : start + most]
