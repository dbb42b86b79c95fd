"""What a method tells of its run: layouts, and when it had them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import multilens as ml
from multilens.records import layout_record

WORTH_TELLING = 1e-4
"""Part of the score by which a layout must be better than the last that was told; the last of all is told anyway."""


@dataclass(frozen=True)
class Found:
    """A layout that a method holds for feasible.

    Args:
        seconds: since the start of its run.
        score: by its own account, mm^2.
        layout: as the library's record, so that it can be sent from one process to another.
    """

    seconds: float
    score: float
    layout: Any


@dataclass(frozen=True)
class Task:
    """One run of one method.

    Args:
        problem: to be solved.
        seed: of the run.
        began: when it began, by the monotonic clock, which all processes of a machine share, s.
        limit: how long it may take, s.
        goal: score at which a method that would go on for ever may end, mm^2; 0 for none.
    """

    problem: ml.Problem
    seed: int
    began: float
    limit: float
    goal: float = 0.0


Method = Callable[[Task], list[Found]]


class OverError(Exception):
    """The clock has stopped in the middle of a run, or its goal is reached."""


class Notebook:
    """Keeps what a run has found, better and better.

    Args:
        task: the run.
        clock: gives the monotonic time, s.
    """

    def __init__(self, task: Task, clock: Callable[[], float]) -> None:
        self.task, self.clock = task, clock
        self.kept: list[Found] = []
        self.last: Found | None = None

    @property
    def seconds(self) -> float:
        """Time since the run began, s."""
        return self.clock() - self.task.began

    @property
    def over(self) -> bool:
        """Whether the run must end."""
        return self.seconds >= self.task.limit or self.best <= self.task.goal

    def refuse_after_the_end(self) -> None:
        """Raise an OverError once the run must end."""
        if self.over:
            raise OverError

    @property
    def best(self) -> float:
        """Least score so far, mm^2, or infinity."""
        return self.last.score if self.last else float("inf")

    def tell(self, score: float, layout: Callable[[], ml.Layout]) -> None:
        """Note a layout if it is better than all before.

        Args:
            score: mm^2, by the method's own account.
            layout: gives it; asked only if it is noted.
        """
        if not score < self.best:
            return
        self.last = Found(self.seconds, score, layout_record(layout(), self.task.problem.lenses))
        if not self.kept or score < self.kept[-1].score * (1 - WORTH_TELLING):
            self.kept.append(self.last)

    def all(self) -> list[Found]:
        """Give what was found, in the order of time."""
        return self.kept if self.last is None or self.last is self.kept[-1] else [*self.kept, self.last]
