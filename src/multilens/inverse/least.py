"""The fewest lenses, the smallest back or the smallest aperture with which some layout measures depth well enough.

More never hurts: a layout on a smaller back, or with smaller apertures, is one on a larger back and with wider apertures too.
So what is proved to be out of reach is so for all less, and what is reached is so for all more. The least lies between the two.
From below it is closed in on by lower bounds, from above by searches.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, sqrt

from multilens.bounds.bound import lower_bound
from multilens.certificate import certify
from multilens.design import Design
from multilens.inverse.answer import NO_ROOM, NOT_FOUND, PROVED, REACHED, Answer, Trial
from multilens.inverse.excess import Excess
from multilens.inverse.resource import BackSize, LensCount, Resource, WidestAperture
from multilens.problem import Problem
from multilens.search.fit import why_nothing_fits
from multilens.search.solve import solve
from multilens.tolerance import Tolerance

Search = Callable[[Problem], Design]
Listener = Callable[[Trial], None]

BOXES = 4000
"""Of apertures that a bound may look at."""

BEYOND = 1 + 3e-4
"""Factor of a score up to which a bound is sought that shall prove it out of reach: bounds end a ten-thousandth below it."""

SHRINKINGS = 30
"""Halvings of the amount that a layout found might do with."""


@dataclass(frozen=True, eq=False)
class _Task:
    """What is asked, and how it is sought.

    Args:
        resource: what there is more or less of.
        goal: the largest figure that is good enough, in the unit of the problem's metric, or a tolerance at every depth.
        search: from a problem to its best design.
        boxes: of apertures that a bound may look at.
        listener: told of every trial.
    """

    resource: Resource
    goal: float | Tolerance
    search: Search
    boxes: int
    listener: Listener

    def asked(self, value: float) -> Problem:
        """Give the problem whose figure says how good a layout is for the goal."""
        problem = self.resource.with_only(value)
        return replace(problem, metric=Excess(self.goal)) if isinstance(self.goal, Tolerance) else problem

    @property
    def most(self) -> float:
        """The largest figure that is good enough."""
        return 1.0 if isinstance(self.goal, Tolerance) else self.goal

    def reached(self, design: Design, figure: float) -> bool:
        """Whether a design is good enough; a tolerance is looked at between the depths too."""
        return design.working_range(self.goal).whole if isinstance(self.goal, Tolerance) else figure <= self.goal

    def tried(self, value: float) -> Trial:
        """Search with so much, and where that is not enough see whether anything could be."""
        problem = self.asked(value)
        design = self.search(problem)
        if not design.feasible:
            return self._told(Trial(value, NO_ROOM if self._crowded(problem) else NOT_FOUND))
        own, figure = self._own(design, value), problem.metric.figure(design.score)
        if self.reached(design, figure):
            return self._told(Trial(value, REACHED, figure, None, own))
        bound = self._bound(problem, design.score)
        verdict = PROVED if bound is not None and bound > self.most else NOT_FOUND
        return self._told(Trial(value, verdict, figure, bound, own))

    def disproved(self, value: float) -> Trial | None:
        """Give the trial that proves so much not to be enough, without a search; None where nothing is proved."""
        problem = self.asked(value)
        if self._crowded(problem):
            return self._told(Trial(value, NO_ROOM))
        bound = self._bound(problem, (self.most / problem.metric.figure(1.0)) ** 2 * BEYOND)
        return None if bound is None or bound <= self.most else self._told(Trial(value, PROVED, None, bound))

    def needed(self, trial: Trial, low: float) -> Trial:
        """Give a trial that was enough with as little as its layout needs, above what is too little."""
        assert trial.design is not None
        high = trial.value
        for _ in range(SHRINKINGS):
            middle = sqrt(low * high)
            if _fits(trial.design, self.resource.with_only(middle)):
                high = middle
            else:
                low = middle
        return replace(trial, value=high, design=self._own(trial.design, high))

    def _crowded(self, problem: Problem) -> bool:
        """Whether it is proved that the lenses have no room."""
        return why_nothing_fits(problem) is not None or lower_bound(problem, 1).proves_that_nothing_fits

    def _bound(self, problem: Problem, target: float) -> float | None:
        bound = lower_bound(problem, self.boxes, target)
        return None if bound.value is None else problem.metric.figure(bound.value)

    def _own(self, design: Design, value: float) -> Design:
        """Give a design as one of the problem as it was asked, with so much of the resource."""
        problem = self.resource.with_only(value)
        certificate = certify(problem.back, problem.lenses, problem.focus_range, design.layout, problem.gap)
        # Of a tolerance the history is in other units than the problem's score.
        tolerance = self.goal if isinstance(self.goal, Tolerance) else None
        others = {"convergence": None, "tolerance": tolerance} if tolerance else {}
        return replace(design, problem=problem, certificate=certificate, bound=None, **others)

    def _told(self, trial: Trial) -> Trial:
        self.listener(trial)
        return trial

    def answer(self, trials: list[Trial]) -> Answer:
        """Give what the trials come to; the design that shows it gets the lower bound of its own problem."""
        metric = self.resource.problem.metric
        goal, head = f"{metric.name} <= {self.most:g} {metric.unit}", f"{metric.name} ({metric.unit})"
        if isinstance(self.goal, Tolerance):
            goal, head = f"error <= {self.goal} at every depth", Excess.name
        ascending = sorted(trials, key=lambda trial: trial.value)
        answer = Answer(self.resource, goal, head, tuple(ascending))
        if answer.best is None or answer.design is None:
            return answer
        bound = lower_bound(answer.design.problem, self.boxes, answer.design.score)
        shown = replace(answer.best, design=replace(answer.design, bound=bound))
        return replace(answer, trials=tuple(shown if trial is answer.best else trial for trial in ascending))


def fewest_lenses(
    problem: Problem,
    goal: float | Tolerance,
    most: int = 8,
    search: Search = solve,
    boxes: int = BOXES,
    listener: Listener = lambda trial: None,
) -> Answer:
    """Find the fewest lenses with which some layout is good enough, counting upward.

    The lenses are those of the problem in their order, the last again and again where more are asked for. Counting ends at the
    first number that is enough, or where the lenses find no room.

    Args:
        problem: what is asked, with any number of lenses.
        goal: the largest figure that is good enough, in the unit of the problem's metric (RMSE, mm, unless said otherwise), > 0;
            or a tolerance to be kept at every depth.
        most: lenses to count up to, >= 1.
        search: from a problem to its best design.
        boxes: of apertures that a bound may look at, >= 1.
        listener: told of every number that was tried.

    Raises:
        ValueError: a number is out of its range.
        TypeError: the question is not of one device as it is drawn, or its score is one's own.
    """
    if most < 1:
        raise ValueError(f"most must be >= 1 lens, got {most}")
    _refuse_other_questions(problem)
    resource = LensCount(problem)
    task = _task(resource, goal, search, boxes, listener)
    trials: list[Trial] = []
    for count in range(1, most + 1):
        if not any(cue.measurements(resource.lenses(count)) for cue in problem.cues):
            # Stereo of a single lens: nothing measures.
            trials.append(Trial(count, PROVED))
            continue
        trials.append(task.tried(count))
        if trials[-1].verdict == REACHED or trials[-1].design is None:
            break
    return task.answer(trials)


def smallest_back(
    problem: Problem,
    goal: float | Tolerance,
    most: float = 1.0,
    precision: float = 0.01,
    search: Search = solve,
    boxes: int = BOXES,
    listener: Listener = lambda trial: None,
) -> Answer:
    """Find the smallest size of the back on which some layout is good enough: see `BackSize` for what shrinks and what stays.

    Args:
        problem: what is asked; its back is of size 1.
        goal: as of `fewest_lenses`.
        most: largest size to look at, > 0.
        precision: part of the size to which it is found, > 0.
        search: from a problem to its best design.
        boxes: of apertures that a bound may look at, >= 1.
        listener: told of every size that was tried.

    Raises:
        ValueError: a number is out of its range, or a smaller back would not lie within a larger one.
        TypeError: as of `fewest_lenses`.
    """
    if not most > 0:
        raise ValueError(f"most must be > 0, got {most:g}")
    _refuse_other_questions(problem)
    resource = BackSize(problem)
    task = _task(resource, goal, search, boxes, listener)
    return _least_between(task, min(resource.least, most), most, precision)


def smallest_aperture(
    problem: Problem,
    goal: float | Tolerance,
    precision: float = 0.01,
    search: Search = solve,
    boxes: int = BOXES,
    listener: Listener = lambda trial: None,
) -> Answer:
    """Find the smallest radius such that some layout whose apertures are all that small is good enough.

    Args:
        problem: what is asked; its lenses' own bounds say where to look.
        goal: as of `fewest_lenses`.
        precision: part of the radius to which it is found, > 0.
        search: from a problem to its best design.
        boxes: of apertures that a bound may look at, >= 1.
        listener: told of every radius that was tried.

    Raises:
        ValueError: a number is out of its range, or the lenses' bounds leave nothing to choose.
        TypeError: as of `fewest_lenses`.
    """
    _refuse_other_questions(problem)
    resource = WidestAperture(problem)
    task = _task(resource, goal, search, boxes, listener)
    least = task.disproved(resource.least) or task.tried(resource.least)
    if least.verdict == REACHED:
        return task.answer([least])
    answer = _least_between(task, resource.least, resource.most, precision)
    return replace(answer, trials=(least, *answer.trials))


def _refuse_other_questions(problem: Problem) -> None:
    if not isinstance(problem, Problem):
        raise TypeError(f"problem must be a Problem, got a {type(problem).__name__}")


def _task(resource: Resource, goal: float | Tolerance, search: Search, boxes: int, listener: Listener) -> _Task:
    if not isinstance(goal, Tolerance) and not goal > 0:
        raise ValueError(f"goal must be > 0 or a tolerance, got {goal:g}")
    return _Task(resource, goal, search, boxes, listener)


def _least_between(task: _Task, low: float, high: float, precision: float) -> Answer:
    """Close in on the least amount that is enough, from below by proof and from above by search.

    Args:
        task: what is asked.
        low: an amount that is not enough, > 0.
        high: the largest to look at.
        precision: part of the amount to which it is found.
    """
    if not precision > 0:
        raise ValueError(f"precision must be > 0, got {precision:g}")
    trials = [task.tried(high)]
    if trials[-1].verdict != REACHED:
        return task.answer(trials)
    trials[-1] = best = task.needed(trials[-1], low)
    unproved = best.value
    while unproved > low * (1 + precision):
        middle = sqrt(low * unproved)
        trial = task.disproved(middle)
        if trial is None:
            unproved = middle
        else:
            trials.append(trial)
            low = middle
    # Where the bound is tight the least is just above what it proves: the first steps up are small, each twice the last.
    step = precision if len(trials) > 1 else inf
    while best.value > low * (1 + precision):
        trial = task.tried(min(sqrt(low * best.value), low * (1 + step)))
        step *= 2
        if trial.verdict == REACHED:
            trial = best = task.needed(trial, low)
        else:
            low = trial.value
        trials.append(trial)
    return task.answer(trials)


def _fits(design: Design, problem: Problem) -> bool:
    return certify(problem.back, problem.lenses, problem.focus_range, design.layout, problem.gap).feasible
