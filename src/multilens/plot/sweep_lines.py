"""The lines of error against the number of lenses: one for every setting of all else."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from multilens.plot.style import LENS_COLOURS
from multilens.plot.sweep_groups import Group, bound_figure, figure_of, grouped, is_asked, varied
from multilens.sweep_row import SweepRow

COUNT = "lenses.count"

MOST_LINES = 8
"""Lines that have a colour and a name; of more the others are grey."""

Name = tuple[tuple[str, str], ...]
"""The settings that set a line apart from the others."""


@dataclass(frozen=True)
class Line:
    """What was found with one setting of all else, for every number of lenses.

    Args:
        group: the rows, also those without a design.
    """

    group: Group

    @property
    def name(self) -> Name:
        """The settings that set it apart from other lines."""
        return self.group.settings

    @cached_property
    def best(self) -> tuple[SweepRow, ...]:
        """The row of the least error for every number of lenses, the fewest first."""
        best: dict[int, SweepRow] = {}
        for row in self.group.found:
            count = row.lens_count or 0
            if count not in best or figure_of(row) < figure_of(best[count]):
                best[count] = row
        return tuple(best[count] for count in sorted(best))

    @property
    def points(self) -> list[tuple[float, float]]:
        """Number of lenses and least error."""
        return [(float(row.lens_count or 0), figure_of(row)) for row in self.best]

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Number of lenses and error that no layout is below, where one is known."""
        known = [(row.lens_count or 0, bound_figure(row)) for row in self.best]
        return [(float(count), bound) for count, bound in known if bound is not None]

    @property
    def gains(self) -> list[tuple[float, float, float]]:
        """Where, in the middle of a step to more lenses, and by which part the error changes there: negative for a gain."""
        return [
            ((x0 + x1) / 2, (y0 * y1) ** 0.5, y1 / y0 - 1)
            for (x0, y0), (x1, y1) in pairwise(self.points)
            if y0 > 0 and y1 > 0
        ]

    @property
    def failed(self) -> list[int]:
        """The numbers of lenses for which nothing was found, as far as the settings tell them."""
        asked = [dict(row.settings).get(COUNT, "") for row in self.group.rows if row.figure is None]
        return [int(count) for count in asked if count.isdecimal()]


def lines(question: Group, rows: Sequence[SweepRow]) -> tuple[Line, ...]:
    """Give a line for every setting of what neither is asked nor tells the number of lenses.

    Args:
        question: rows that compare.
        rows: of the whole sweep, which tell the keys that vary.
    """
    telling = _keys_that_tell_the_count(rows)
    keys = [key for key in varied(rows) if not is_asked(key) and key not in telling]
    return tuple(Line(group) for group in grouped(question.rows, keys))


def colours(every: Sequence[Line]) -> dict[Name, str]:
    """Give a colour to each name, where there are too many to those of the least error, and none to the others."""
    least: dict[Name, float] = {}
    for line in every:
        least[line.name] = min([least.get(line.name, float("inf")), *(figure for _, figure in line.points)])
    coloured = set(sorted(least, key=lambda name: least[name])[:MOST_LINES])
    return {name: LENS_COLOURS[k] for k, name in enumerate(name for name in least if name in coloured)}


def _keys_that_tell_the_count(rows: Sequence[SweepRow]) -> set[str]:
    """Give the keys of lenses of which each value comes with one number of lenses, and not all with the same."""
    if COUNT in varied(rows):
        return {COUNT}
    telling = set()
    for key in varied(rows):
        counts = [{row.lens_count for row in group.found} for group in grouped(rows, [key])]
        if key.split(".")[0] == "lenses" and max(map(len, counts)) == 1 and len(set.union(*counts)) > 1:
            telling.add(key)
    return telling
