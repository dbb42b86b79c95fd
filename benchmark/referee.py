"""The referee, the same for all: a layout counts if, made legal, its exact certificate says that it is feasible."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import multilens as ml
from benchmark.found import Found
from multilens.records import layout_record, read_layout
from multilens.search.legalise import legalise


@dataclass(frozen=True)
class Judged:
    """A layout that counts.

    Args:
        seconds: when the method had it.
        score: of the legal layout, by the library, mm^2.
        layout: the legal layout's record.
    """

    seconds: float
    score: float
    layout: Any


def judge(problem: ml.Problem, found: Sequence[Found]) -> list[Judged]:
    """Give what counts of a run, better and better; it is asked after the clock has stopped.

    Args:
        problem: that was to be solved.
        found: in the order of time.
    """
    best: list[Judged] = []
    for each in found:
        # What a method itself holds for no better than what counts already need not be certified: that takes time.
        if best and each.score >= best[-1].score * (1 - 1e-9):
            continue
        layout, certificate = legalise(problem, read_layout(each.layout, "layout", problem.lenses))
        if not certificate.feasible:
            continue
        score = problem.score(layout).item()
        if not best or score < best[-1].score:
            best.append(Judged(each.seconds, score, layout_record(layout, problem.lenses)))
    return best
