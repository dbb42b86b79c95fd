"""A design: one layout that answers a question, with its proof and its origin."""

from dataclasses import dataclass
from functools import cached_property
from math import isclose, nan, sqrt
from pathlib import Path
from typing import Any

from multilens.bounds.bound import Bound
from multilens.bounds.record import bound_record, read_bound
from multilens.certificate import Certificate, certify
from multilens.convergence import Convergence
from multilens.coverage import coverage_in_words
from multilens.documents import document, document_content, read_text
from multilens.fields import choice, number, record
from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.layout import Layout
from multilens.layout_table import f_numbers, foci, layout_lines
from multilens.metrics import MeanSquare
from multilens.problem import Problem
from multilens.question import Question
from multilens.records import (
    certificate_record,
    convergence_record,
    layout_record,
    noun_record,
    origin_record,
    problem_record,
    read_certificate,
    read_convergence,
    read_layout,
    read_noun,
    read_origin,
    read_problem,
)
from multilens.robust import Robust, as_drawn
from multilens.sensitivity import Sensitivity, sensitivity
from multilens.storage import Origin, write_whole
from multilens.tolerance import Tolerance
from multilens.working_range import WorkingRange, working_range

COMPLETE, OUT_OF_TIME, INFEASIBLE, GIVEN = "complete", "time limit", "infeasible", "as given"

SCHEMA, SCHEMA_VERSION = "multilens.design", 2
NUMBERS, PARTS = ("score", "figure", "rmse", "measured"), ("certificate", "origin", "convergence", "bound")

ROUNDING = 1e-9
"""Part of a score by which a lower bound may lie above it, where both are as good as they can be."""

OTHERS = 2**31 - 1
"""Seed of the devices on which a design for many devices is tried once it is found: the last there is."""

TOUCHING = 1e-6
"""mm; bodies that a search has brought so close are told to touch."""

SAME = 1e-12
"""Largest relative difference between a stored score and the one that its layout has: a few roundings, no more."""


@dataclass(frozen=True, eq=False)
class Design:
    """One answer.

    Args:
        problem: what was asked.
        layout: one layout in float64, as stored.
        status: "complete", "time limit" (the best when time ran out), "infeasible", or "as given" for a layout that was not
            searched for: it is scored even where it breaks a constraint, as hardware that exists may.
        reason: why it is infeasible; empty otherwise.
        certificate: every constraint, checked exactly.
        convergence: of the starts; None for a layout that was not searched for.
        origin: what made it; None for a layout that was not searched for.
        bound: below which no feasible layout of this problem scores, or why none is known; None where none was sought.
        tolerance: within which its working range is told and drawn; None where nobody asked.
    """

    problem: Question
    layout: Layout
    status: str
    reason: str
    certificate: Certificate
    convergence: Convergence | None = None
    origin: Origin | None = None
    bound: Bound | None = None
    tolerance: Tolerance | None = None

    @property
    def feasible(self) -> bool:
        """Whether the layout keeps every constraint, exactly."""
        return self.certificate.feasible if self.status == GIVEN else self.status != INFEASIBLE

    @cached_property
    def score(self) -> float:
        """Exact score, in the metric's `score_unit`, mm^2 as it is (for a score of one's own, in its unit); NaN if infeasible."""
        return self.problem.score(self.layout).item() if self.status != INFEASIBLE else nan

    @cached_property
    def rmse(self) -> float:
        """Root-mean-square error of depth, mm, whichever metric was asked for, or root of a score of one's own; NaN if none."""
        if isinstance(drawn := as_drawn(self.problem), Problem) and self.status != INFEASIBLE:
            is_score = drawn is self.problem and isinstance(drawn.metric, MeanSquare)
            return sqrt(self.score if is_score else drawn.mean_square(self.layout).item())
        return sqrt(self.score) if self.score >= 0 else nan

    @property
    def figure(self) -> float:
        """The score as people quote it, in the metric's `unit`; a score of one's own as it is; NaN if infeasible."""
        metric = self.problem.metric
        return self.score if metric is None or self.status == INFEASIBLE else metric.figure(self.score)

    @cached_property
    def measured(self) -> float:
        """Share of the depths, by weight, at which anything measures, 1 unless cues may fail; NaN if infeasible or no Problem."""
        if not isinstance(drawn := as_drawn(self.problem), Problem) or self.status == INFEASIBLE:
            return nan
        return drawn.measured(self.layout).item()

    @property
    def gap(self) -> float:
        """How far from the best possible the score may be, as a part of it: 1 - bound / score, 0 at best; NaN if unknown."""
        if self.bound is None or self.bound.value is None or not self.feasible:
            return nan
        # Bound and score are rounded apart: at the very best they may seem to cross.
        return max(0.0, 1 - self.bound.value / self.score) if self.score > 0 else 0.0

    @property
    def f_numbers(self) -> tuple[float, ...]:
        """N = f / (2 A) of each lens."""
        return f_numbers(self.layout, self.problem.lenses)

    @property
    def foci(self) -> tuple[tuple[float, ...], ...]:
        """In-focus depth of each tier that each lens has, mm."""
        return foci(self.layout, self.problem.lenses)

    @property
    def longest_baseline(self) -> tuple[float, tuple[int, int]] | None:
        """Distance of the two lenses farthest apart, mm, and the index of each, from 0; None for a single lens."""
        if self.layout.count < 2:
            return None
        distance = pair_distance(self.layout.position)
        first, second = pair_indices(self.layout.count)[:, distance.argmax()].tolist()
        return distance.max().item(), (first, second)

    def working_range(self, tolerance: Tolerance, span: tuple[float, float] | None = None) -> WorkingRange:
        """Give the depths at which the error of the device, as it is drawn, is within a tolerance; see `multilens.working_range`.

        Args:
            tolerance: largest error.
            span: nearest and farthest depth to look at, mm; None takes the range of the problem.

        Raises:
            ValueError: nothing was found to measure with, the question has no depths, or the span is out of its range.
        """
        problem = as_drawn(self.problem)
        if not isinstance(problem, Problem) or self.status == INFEASIBLE:
            raise ValueError("design must have a layout and depths to have a working range")
        return working_range(problem, self.layout, tolerance, span)

    def save(self, path: str | Path) -> None:
        """Write the design to a JSON file, whole or not at all; the same design gives the same bytes.

        What is written is first read back and proved feasible once more, so that what was saved can be loaded.

        Args:
            path: of the file, which is replaced if it is there.

        Raises:
            ValueError: the design is infeasible, or does not hold what it claims.
            TypeError: the problem has a score or a cue of one's own: code is never written to a file.
            OSError: the file cannot be written.
        """
        write_whole(Path(path), self.to_json())

    @classmethod
    def load(cls, path: str | Path) -> "Design":
        """Read a design that was saved; its score and its feasibility are derived anew from the layout.

        Every number is the same to the bit; the history of the search has 6 significant digits.

        Args:
            path: of the file.

        Raises:
            ValueError: the file is cut off, altered, of another version, or claims what does not hold; the file is named.
            OSError: it cannot be read.
        """
        try:
            return cls.from_json(read_text(Path(path)))
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None

    def sensitivity(self) -> Sensitivity:
        """Give what it costs that one lens is off its place, its aperture or its focus, or is covered.

        Raises:
            ValueError: the design is infeasible, or its score is one's own.
        """
        if not isinstance(drawn := as_drawn(self.problem), Problem) or self.status == INFEASIBLE:
            raise ValueError("design must have a layout and depths to have a sensitivity")
        return sensitivity(drawn, self.layout)

    def plot(self) -> Any:
        """Draw the back, the errors and who wins at which depth on one sheet.

        Returns:
            A matplotlib Figure, of which `savefig` makes a file.
        """
        # Loaded only where something is drawn: it costs a second.
        from multilens.plot.figures import overview_figure

        return overview_figure(self.problem, self.layout, self.tolerance)

    def to_json(self) -> str:
        """Give the text that `save` writes; raises what it raises, save for the OSError."""
        if self.status == INFEASIBLE:
            raise ValueError(f"design must be feasible to be saved: {self.reason}")
        content = {
            "units": _units(self.problem),
            "status": self.status,
            "score": self.score,
            "figure": self.figure,
            "rmse": self.rmse,
            "measured": self.measured,
            "layout": layout_record(self.layout, self.problem.lenses),
            "problem": problem_record(self.problem),
            "certificate": certificate_record(self.certificate),
            "origin": None if self.origin is None else origin_record(self.origin),
            "convergence": None if self.convergence is None else convergence_record(self.convergence),
            "bound": None if self.bound is None else bound_record(self.bound),
        }
        if self.tolerance is not None:
            content["tolerance"] = noun_record(self.tolerance)
        written = document(SCHEMA, SCHEMA_VERSION, content)
        Design.from_json(written)
        return written

    @classmethod
    def from_json(cls, text: str) -> "Design":
        """Read the text that `to_json` gives.

        Raises:
            ValueError: as for `load`.
        """
        content = document_content(text, SCHEMA, SCHEMA_VERSION)
        keys = ("units", "status", *NUMBERS, "layout", "problem", *PARTS)
        fields = record(content, "design", keys, optional=["tolerance"])
        status = choice(fields["status"], "status", (COMPLETE, OUT_OF_TIME, GIVEN))
        problem = read_problem(fields["problem"], "problem")
        if fields["units"] != (units := _units(problem)):
            raise ValueError(f"units must be {units}, got {fields['units']!r:.80}")
        layout = read_layout(fields["layout"], "layout", problem.lenses)
        certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
        design = cls(
            problem,
            layout,
            status,
            "",
            certificate,
            None if fields["convergence"] is None else read_convergence(fields["convergence"], "convergence"),
            None if fields["origin"] is None else read_origin(fields["origin"], "origin"),
            None if fields["bound"] is None else read_bound(fields["bound"], "bound"),
            read_noun(Tolerance, fields["tolerance"], "tolerance") if "tolerance" in fields else None,
        )
        _refuse_unless_it_holds(design, fields)
        return design

    def facts(self) -> dict[str, str]:
        """Give what is told of a design that was found, beside its lenses: words by name, such as RMSE and lower bound."""
        facts = {"status": self.status}
        metric = self.problem.metric
        if metric is None:
            facts["score"] = f"{self.score:.6g}"
        else:
            facts[metric.name] = f"{self.figure:.6g} {metric.unit}"
        if isinstance(self.problem, Robust):
            if self.problem.disturbance.varies:
                others = self.problem.afresh(OTHERS)
                facts["of other devices"] = (
                    f"{others.metric.figure(others.score(self.layout).item()):.6g} {others.metric.unit}"
                )
            facts["RMSE as drawn"] = f"{self.rmse:.6g} mm"
        if isinstance(self.problem, Problem):
            facts["RMSE"] = f"{self.rmse:.6g} mm"
            if self.measured < 1 - ROUNDING:
                facts["measured"] = f"{100 * self.measured:.3g} % of the depths"
                if self.problem.prior_error is not None:
                    facts["measured"] += f"; the error of the others is a guess, {self.problem.prior_error:.4g} mm"
            if self.problem.field is not None:
                facts["depths and field"] = coverage_in_words(self.problem, self.layout)
        if self.tolerance is not None:
            facts["working range"] = str(self.working_range(self.tolerance))
        if self.longest_baseline is not None:
            baseline, (first, second) = self.longest_baseline
            facts["longest baseline"] = f"{baseline:.3f} mm, lens {first + 1} to lens {second + 1}"
        if self.bound is not None:
            facts["lower bound"] = self._bound_in_words(self.bound)
        closest = self.certificate.closest
        room = 0.0 if closest.kept and closest.room < TOUCHING else closest.room
        lacks = "" if closest.kept else "lacks "
        facts["tightest clearance"] = f"{lacks}{abs(room):.3g} mm, {closest.what}"
        return facts

    def __str__(self) -> str:
        if self.status == INFEASIBLE:
            return f"{self.status}: {self.reason}"
        table, facts = layout_lines(self.layout, self.problem.lenses), self.facts()
        wide = max(map(len, facts))
        return "\n".join([*table, "", *(f"{name:<{wide}}  {fact}" for name, fact in facts.items())])

    def _bound_in_words(self, bound: Bound) -> str:
        if bound.value is None:
            return bound.reason
        metric = self.problem.metric
        least = f"score below {bound.value:.6g}"
        if metric is not None:
            least = f"{metric.name} below {metric.figure(bound.value):.6g} {metric.unit}"
        article = "an" if least.startswith("RMSE") else "a"
        return f"no layout can have {article} {least}; gap {100 * self.gap:.2g} % of the score"


def _units(problem: Question) -> dict[str, str]:
    """Give the unit of every kind of number in a file."""
    units = {"length": "mm", "rmse": "mm", "time": "s"}
    metric = problem.metric
    return units if metric is None else units | {"score": metric.score_unit, "figure": metric.unit}


def _refuse_unless_it_holds(design: Design, fields: dict[str, Any]) -> None:
    """Hold what a file claims against what its layout gives."""
    if not design.certificate.feasible and design.status != GIVEN:
        tightest = design.certificate.tightest
        raise ValueError(f"layout must be feasible, got {tightest.what} lacking {-tightest.room:.4g} mm")
    for name in NUMBERS:
        actual = getattr(design, name)
        stored = number(fields[name], name)
        # A share is 1 less what fails, rounded as 1 is.
        if not isclose(stored, actual, rel_tol=SAME, abs_tol=SAME if name == "measured" else 0.0):
            raise ValueError(f"{name} must be the layout's, {actual!r}, got {stored!r}")
    bound = design.bound
    if bound is not None and bound.value is not None and not 0 <= bound.value <= design.score * (1 + ROUNDING):
        raise ValueError(f"bound.value must be from 0 to the score, {design.score!r}, got {bound.value!r}")
    stored = read_certificate(fields["certificate"], "certificate").clearances
    actual = design.certificate.clearances
    if [(c.what, c.kept) for c in stored] != [(c.what, c.kept) for c in actual]:
        raise ValueError("certificate must be the layout's, got other clearances")
    for index, (claimed, found) in enumerate(zip(stored, actual, strict=True)):
        if not isclose(claimed.room, found.room, rel_tol=SAME, abs_tol=SAME):
            raise ValueError(f"certificate[{index}].room must be the layout's, {found.room!r}, got {claimed.room!r}")
