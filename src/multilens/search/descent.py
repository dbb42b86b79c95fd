"""The wide search: many starts descend at once, each by itself, while the minimum sharpens and the penalty grows."""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, nan, pi

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.penalty import Price
from multilens.problem import Question
from multilens.search.variables import Variables

NEARLY_FEASIBLE = 1e-3
"""Penalty below which a start's score is worth showing while the search runs."""

LEAST_SCORE = 1e-12
"""Size of a score, mm^2 or its own unit, below which the descent follows the score itself: its logarithm has no end at 0."""


@dataclass(frozen=True)
class DescentSettings:
    """How the wide search goes from rough to fine; each pair is a first and a last value, passed through by equal factors.

    Args:
        steps: how many, >= 1.
        temperature: of the soft minimum over the measurements, without unit.
        penalty: weight of the penalty against the logarithm of the score.
        rate: length of a step in units of each unknown's range; it falls along a cosine from the first to the last value.
    """

    steps: int = 240
    temperature: tuple[float, float] = (2.0, 0.05)
    penalty: tuple[float, float] = (1.0, 1e4)
    rate: tuple[float, float] = (0.03, 0.0005)

    def __post_init__(self) -> None:
        if self.steps < 1:
            raise ValueError(f"steps must be >= 1, got {self.steps}")


@dataclass(frozen=True)
class Descent:
    """Where the starts have come to.

    Args:
        x: vector of each start.
        score: exact score of each, mm^2, without penalty; NaN for a start that failed.
        price: penalty of each, 0 where feasible.
        history: score of each at every recorded step.
        history_steps: which steps were recorded.
    """

    x: Float[Tensor, "s d"]
    score: Float[Tensor, " s"]
    price: Float[Tensor, " s"]
    history: Float[Tensor, "s h"]
    history_steps: tuple[int, ...]


def descend(
    question: Question,
    variables: Variables,
    price: Price,
    x: Float[Tensor, "s d"],
    settings: DescentSettings,
    go_on: Callable[[int, int, float], bool],
) -> Descent:
    """Let every start descend its own loss with Adam.

    The loss of a start is the logarithm of its smooth score plus the weighted penalty, so that neither the unit of the score
    nor the other starts matter to it. A start whose gradient is not finite stays where it is and is reported as NaN.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
        price: the penalty, made for this question.
        x: where the starts begin.
        settings: how to go from rough to fine.
        go_on: called before every step with the step, how many starts are healthy and the best score of a nearly feasible
            one; False ends the descent.
    """
    first_moment, second_moment = torch.zeros_like(x), torch.zeros_like(x)
    healthy = torch.ones(len(x), dtype=torch.bool, device=x.device)
    recorded, recorded_steps = [], []
    every = max(1, settings.steps // 60)
    for step in range(settings.steps):
        done = step / max(1, settings.steps - 1)
        x = x.detach().requires_grad_()
        layout = variables.layout(x)
        smooth = question.loss(layout, _between(settings.temperature, done))
        missing = price(layout)
        # Dividing by the score itself makes this the gradient of its logarithm, also where the score is negative.
        loss = smooth / smooth.detach().abs().clamp(min=LEAST_SCORE) + _between(settings.penalty, done) * missing
        (gradient,) = torch.autograd.grad(loss.sum(), x)
        healthy &= gradient.isfinite().all(-1) & smooth.isfinite()
        if step % every == 0:
            with torch.no_grad():
                score = torch.where(healthy, question.terms(layout).amax(-1), torch.nan)
            recorded.append(score)
            recorded_steps.append(step)
            nearly = healthy & (missing.detach() < NEARLY_FEASIBLE)
            if not go_on(step, int(healthy.sum()), score[nearly].min().item() if nearly.any() else nan):
                break
        gradient = torch.where(healthy.unsqueeze(-1), gradient, 0)
        first_moment = 0.9 * first_moment + 0.1 * gradient
        second_moment = 0.99 * second_moment + 0.01 * gradient.square()
        mean = first_moment / (1 - 0.9 ** (step + 1))
        spread = (second_moment / (1 - 0.99 ** (step + 1))).sqrt()
        rate = settings.rate[1] + (settings.rate[0] - settings.rate[1]) * (1 + cos(pi * done)) / 2
        x = (x.detach() - rate * mean / (spread + 1e-12)).clamp(min=0).minimum(variables.upper)
    x = x.detach()
    with torch.no_grad():
        layout = variables.layout(x)
        score = torch.where(healthy, question.terms(layout).amax(-1), torch.nan)
        return Descent(x, score, price(layout), torch.stack(recorded, dim=-1), tuple(recorded_steps))


def _between(ends: tuple[float, float], done: float) -> float:
    return ends[0] * (ends[1] / ends[0]) ** done
