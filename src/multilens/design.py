"""A design: one layout that answers a question, with its proof and its origin."""

from dataclasses import dataclass, field
from math import nan, sqrt

from multilens.certificate import Certificate
from multilens.convergence import Convergence
from multilens.layout import Layout
from multilens.problem import Question

COMPLETE, OUT_OF_TIME, INFEASIBLE = "complete", "time limit", "infeasible"


@dataclass(frozen=True)
class Origin:
    """What made a design: enough to make it again.

    Args:
        seed: of the starts.
        starts: how many descended.
        polished: how many of the best were polished at most.
        penalty: name of the penalty.
        time_limit: s, or None.
        versions: of Python and the libraries.
        commit: of the source, with a "+" if it was changed since; None where unknown.
    """

    seed: int
    starts: int
    polished: int
    penalty: str
    time_limit: float | None
    versions: dict[str, str] = field(default_factory=dict)
    commit: str | None = None


@dataclass(frozen=True, eq=False)
class Design:
    """One answer.

    Args:
        problem: what was asked.
        layout: one layout in float64, as stored.
        status: "complete", "time limit" (the best when time ran out) or "infeasible".
        reason: why it is infeasible; empty otherwise.
        certificate: every constraint, checked exactly.
        convergence: of the starts; None for a layout that was not searched for.
        origin: what made it; None for a layout that was not searched for.
    """

    problem: Question
    layout: Layout
    status: str
    reason: str
    certificate: Certificate
    convergence: Convergence | None = None
    origin: Origin | None = None

    @property
    def feasible(self) -> bool:
        """Whether the layout keeps every constraint, exactly."""
        return self.status != INFEASIBLE

    @property
    def score(self) -> float:
        """Exact score, mm^2 (for a score of one's own, in its unit); NaN if infeasible."""
        return self.problem.terms(self.layout).amax(-1).item() if self.feasible else nan

    @property
    def rmse(self) -> float:
        """Root of the score: the root-mean-square error of depth, mm; NaN if infeasible or the score is negative."""
        return sqrt(self.score) if self.score >= 0 else nan
