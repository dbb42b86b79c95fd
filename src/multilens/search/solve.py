"""Solve a question: many starts descend, the best are polished, and the best of those is proved feasible."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, nan
from time import monotonic

import torch
from torch import Tensor

from multilens.certificate import Certificate
from multilens.convergence import Convergence
from multilens.design import COMPLETE, INFEASIBLE, OUT_OF_TIME, Design, Origin
from multilens.layout import Layout
from multilens.penalty import Price, distance_penalty
from multilens.problem import Question
from multilens.search.descent import Descent, DescentSettings, descend
from multilens.search.fit import why_nothing_fits
from multilens.search.legalise import legalise
from multilens.search.polish import OutOfTimeError, polish
from multilens.search.progress import Listener, Progress
from multilens.search.refocus import refocus
from multilens.search.starts import scattered_starts
from multilens.search.threads import one_thread
from multilens.search.variables import Variables
from multilens.storage import source_commit, versions

DESCENT_SHARE = 0.5
"""Part of a time limit that the descent may take; the polish, which makes a layout feasible, has the rest."""

ALIKE = 1e-4
"""Starts whose penalised scores differ by less than about this part count as the same layout, and one of them is polished."""

ROUGH = 1e-9
"""Part of the score to which all candidates are polished; the best of them is then polished to the end."""


def solve(
    problem: Question,
    starts: int = 128,
    seed: int = 0,
    time_limit: float | None = None,
    polished: int = 16,
    penalty: Callable[[Question], Price] = distance_penalty,
    descent: DescentSettings | None = None,
    listener: Listener = lambda progress: None,
) -> Design:
    """Find the layout that answers a question best.

    Args:
        problem: what is asked.
        starts: how many layouts descend at once, >= 1.
        seed: of the starts; the same seed on the same machine gives the same design to the bit, unless time ran out.
        time_limit: after which the best so far is given, s; None waits to the end.
        polished: how many of the best distinct starts are polished, >= 1.
        penalty: what a start pays for room that is not there: `distance_penalty` or `area_penalty`.
        descent: how the starts go from rough to fine; None takes the defaults.
        listener: told of the progress some sixty times and after every polish.

    Returns:
        The best feasible design; or, with the status "infeasible" and a reason, the layout that came nearest to being so.

    Raises:
        ValueError: a number is out of its range.
        RuntimeError: no start stayed healthy: every one met a score or a gradient that is not finite.
    """
    for name, number in (("starts", starts), ("polished", polished)):
        if number < 1:
            raise ValueError(f"{name} must be >= 1, got {number}")
    if time_limit is not None and not time_limit > 0:
        raise ValueError(f"time_limit must be > 0 s, got {time_limit:g}")
    origin = Origin(
        seed, starts, polished, getattr(penalty, "__name__", repr(penalty)), time_limit, versions(), source_commit()
    )
    began = monotonic()
    variables = Variables(problem)
    x = scattered_starts(problem, variables, starts, seed)
    reason = why_nothing_fits(problem)
    if reason is not None:
        layout, certificate = legalise(problem, variables.layout(x[0]))
        return Design(problem, layout, INFEASIBLE, reason, certificate, origin=origin)

    settings = descent or DescentSettings()
    end = inf if time_limit is None else began + time_limit
    with one_thread():
        descended = _descend_all(problem, x, settings, penalty, began, end, listener)
        order = _best_first(descended, settings.penalty[1])[:polished]
        best, scores, in_time = _polish_each(problem, variables, descended, order, end, listener)
    convergence = Convergence(descended.history_steps, descended.history, tuple(order), tuple(scores))
    if best.certificate.feasible:
        status = COMPLETE if in_time else OUT_OF_TIME
        return Design(problem, best.layout, status, "", best.certificate, convergence, origin)
    tightest = best.certificate.tightest
    searched = "" if in_time else f" in {time_limit:g} s"
    reason = f"no feasible layout found{searched}: at best {tightest.what} lacks {-tightest.room:.4g} mm"
    return Design(problem, best.layout, INFEASIBLE, reason, best.certificate, convergence, origin)


@dataclass(frozen=True)
class _Candidate:
    """A layout as it would be claimed: rounded, certified, scored (NaN if infeasible)."""

    x: Tensor
    layout: Layout
    certificate: Certificate
    score: float

    @classmethod
    def of(cls, problem: Question, variables: Variables, x: Tensor) -> "_Candidate":
        layout, certificate = legalise(problem, variables.layout(x))
        return cls(x, layout, certificate, problem.terms(layout).amax().item() if certificate.feasible else nan)

    def better_than(self, other: "_Candidate") -> bool:
        """Whether it scores less; among infeasible ones, whether it lacks less."""
        if self.certificate.feasible and other.certificate.feasible:
            return self.score < other.score
        if self.certificate.feasible or other.certificate.feasible:
            return self.certificate.feasible
        return self.certificate.tightest.room > other.certificate.tightest.room


def _descend_all(
    problem: Question,
    x: Tensor,
    settings: DescentSettings,
    penalty: Callable[[Question], Price],
    began: float,
    end: float,
    listener: Listener,
) -> Descent:
    half_time = began + DESCENT_SHARE * (end - began)

    def go_on(step: int, alive: int, best: float) -> bool:
        now = monotonic()
        whole = settings.steps / max(step, 1) * (now - began) / DESCENT_SHARE
        listener(Progress("descent", step / settings.steps, len(x), alive, best, min(began + whole, end) - now))
        return now < half_time or step == 0

    # Single precision is twice as fast and plenty to tell basins apart; the polish goes on in double.
    variables = Variables(problem, torch.float32)
    descended = descend(problem, variables, penalty(problem), x.float(), settings, go_on)
    if not descended.score.isfinite().any():
        raise RuntimeError(f"none of the {len(x)} starts stayed healthy: scores or gradients were not finite")
    return descended


def _best_first(descended: Descent, weight: float) -> list[int]:
    """Give the healthy starts in order of score and penalty, of those that came to the same place only one."""
    scale = descended.score.abs().nanmedian().clamp(min=torch.finfo(descended.score.dtype).tiny)
    merit = descended.score.sign() * (descended.score.abs() / scale).log1p() + weight * descended.price
    kept: list[int] = []
    for index in merit.argsort().tolist():
        if merit[index].isfinite() and (not kept or merit[index] - merit[kept[-1]] > ALIKE):
            kept.append(index)
    return kept


def _polish_each(
    problem: Question,
    variables: Variables,
    descended: Descent,
    order: list[int],
    end: float,
    listener: Listener,
) -> tuple[_Candidate, list[float], bool]:
    """Polish the starts in order until the end; give the best layout, every score, and whether there was time for all."""
    x, scores = descended.x.double(), []
    best = _Candidate.of(problem, variables, x[order[0]])
    # Should time run out before the first polish, the best of those that are feasible as they are is still an answer.
    for index in order[1:]:
        if best.certificate.feasible or monotonic() > end:
            break
        candidate = _Candidate.of(problem, variables, x[index])
        best = candidate if candidate.better_than(best) else best
    began, alive = monotonic(), int(descended.score.isfinite().sum())
    try:
        for done, index in enumerate(order, start=1):
            polished = polish(problem, variables, refocus(problem, variables, x[index]), end, ROUGH)
            candidate = _Candidate.of(problem, variables, polished)
            scores.append(candidate.score)
            best = candidate if candidate.better_than(best) else best
            now = monotonic()
            left = min((now - began) / done * (len(order) - done), end - now)
            listener(Progress("polish", done / len(order), len(x), alive, best.score, left))
        finest = _Candidate.of(problem, variables, polish(problem, variables, best.x, end))
    except OutOfTimeError:
        return best, scores, False
    return finest if finest.better_than(best) else best, scores, True
