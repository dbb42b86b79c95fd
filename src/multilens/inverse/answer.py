"""What a question asked backwards comes to: every amount that was tried, and what is certain about the least that is enough."""

from dataclasses import dataclass

from multilens.design import Design
from multilens.inverse.resource import Resource

REACHED, PROVED, NOT_FOUND, NO_ROOM = "enough", "not enough: proved", "none found", "no room: proved"
"""Verdicts: a layout reaches what is asked; none can; the search found none, which proves nothing; the lenses do not fit."""


@dataclass(frozen=True, eq=False)
class Trial:
    """One amount that was tried.

    Args:
        value: how much there was.
        verdict: "enough", "not enough: proved", "none found" (which proves nothing) or "no room:
            proved".
        figure: of the best layout found, in the unit of what is asked; None where none was searched for or none fits.
        bound: below which no layout comes, in the same unit; None where none is known.
        design: that layout; None where there is none.
    """

    value: float
    verdict: str
    figure: float | None = None
    bound: float | None = None
    design: Design | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """The least amount that was found to be enough.

    Args:
        resource: what there is more or less of.
        goal: what is asked, in words.
        head: what the figures are, with their unit.
        trials: every amount that was tried, ascending.
    """

    resource: Resource
    goal: str
    head: str
    trials: tuple[Trial, ...]

    @property
    def best(self) -> Trial | None:
        """The least amount that is enough; None where none was."""
        return min((t for t in self.trials if t.verdict == REACHED), key=lambda trial: trial.value, default=None)

    @property
    def value(self) -> float | None:
        """How much that is; None where nothing was enough."""
        return None if self.best is None else self.best.value

    @property
    def design(self) -> Design | None:
        """The layout that shows it; None where nothing was enough."""
        return None if self.best is None else self.best.design

    @property
    def proved_below(self) -> float | None:
        """The largest amount that is proved not to be enough, and with it all less; None where nothing is proved."""
        return max((trial.value for trial in self.trials if trial.verdict in (PROVED, NO_ROOM)), default=None)

    def __str__(self) -> str:
        rows = [(self.resource.name, self.head, "none can be below", "verdict")]
        for trial in self.trials:
            figure, bound = ("-" if number is None else f"{number:.5g}" for number in (trial.figure, trial.bound))
            rows.append((self.resource.words(trial.value), figure, bound, trial.verdict))
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        table = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
        return "\n".join([f"least {self.resource.name} for {self.goal}", "", *table, "", *self._conclusion()])

    def _conclusion(self) -> list[str]:
        missed = max((trial.value for trial in self.trials if trial.verdict == NOT_FOUND), default=None)
        proved = self.proved_below
        lines = []
        if self.best is None:
            lines.append("nothing that was tried is enough")
        else:
            lines.append(f"enough          {self.resource.words(self.best.value)}")
        if proved is not None:
            lines.append(f"not enough      {self.resource.words(proved)}, proved")
        if missed is not None and (proved is None or missed > proved):
            lines.append(
                f"not known       {self.resource.words(missed)}: no layout was found, which does not prove that there is none"
            )
        return lines
