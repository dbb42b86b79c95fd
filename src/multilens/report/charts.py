"""Which charts a sweep has: what is compared with what, and which points are joined."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from multilens.plot.linked import Series, linked_svg
from multilens.plot.style import LENS_COLOURS, RULE
from multilens.plot.sweep_front import front
from multilens.plot.sweep_groups import Group, grouped, in_words, is_asked, questions, short_names, varied
from multilens.sweep_row import SweepRow

DIGITS = 6
"""That count: what differs less is alike, so that rounding makes no front."""

MOST_QUESTIONS = 12
"""Questions that have charts: each has one for every pair of axes."""

FRONT, OTHERS = LENS_COLOURS[0], "#8c8c8c"

UNBEATEN, BEATEN = "no other is better in both", "others"


@dataclass(frozen=True)
class Axis:
    """A number that rows have.

    Args:
        words: what it is, with its unit.
        of: gives it; None where a row has none.
        key: of the configuration that it is a value of; empty where it came of the design.
    """

    words: str
    of: Callable[[SweepRow], float | None]
    key: str = ""


@dataclass(frozen=True)
class Chart:
    """One chart.

    Args:
        question: what was asked of its jobs, in words; empty where all were asked the same.
        right: words of what runs to the right.
        up: words of what runs upwards.
        svg: the picture.
    """

    question: str
    right: str
    up: str
    svg: str


FIGURES = (
    Axis("lenses", lambda row: row.lens_count),
    Axis("area of all apertures (mm²)", lambda row: row.aperture_area),
    Axis("area of all bodies (mm²)", lambda row: row.body_area),
    Axis("area of the back (mm²)", lambda row: row.back_area),
    Axis("longest baseline (mm)", lambda row: row.longest_baseline),
    Axis("time of the search (s)", lambda row: row.time),
)


def charts(rows: Sequence[SweepRow], words: Callable[[SweepRow], str]) -> tuple[Chart, ...]:
    """Give a chart for everything that was asked and every pair of axes along which its jobs differ.

    Along a swept number jobs that are alike in all else are joined; along anything else those that no other beats in both.

    Args:
        rows: of the sweep.
        words: for whoever points at a job.
    """
    names, links = short_names(varied(rows)), {where(row): words(row) for row in rows}
    found = []
    for question in questions(rows)[:MOST_QUESTIONS]:
        for up in _upwards(question):
            for right in _rightwards(question, rows):
                known = [row for row in question.found if None not in (right.of(row), up.of(row))]
                if len({_rounded(right, row) for row in known}) < 2:
                    continue
                series = _lines(known, rows, right, up) if right.key else _front(known, right, up)
                asked = in_words(question.settings, names)
                label = f"{up.words} against {right.words}{', ' + asked if asked else ''}; each point leads to its job."
                whole = all(number == round(number) for number in (right.of(row) or 0.0 for row in known))
                svg = linked_svg(series, (right.words, up.words), f"chart-{len(found)}", label, links, whole)
                found.append(Chart(asked, right.words, up.words, svg))
    return tuple(found)


def where(row: SweepRow) -> str:
    """Give the place on the page that a job's link leads to."""
    return f"#job-{row.job}"


def _rightwards(question: Group, rows: Sequence[SweepRow]) -> list[Axis]:
    numbers = [key for key, values in varied(rows).items() if not is_asked(key) and all(map(is_number, values))]
    swept = [Axis(key, lambda row, key=key: float(dict(row.settings)[key]), key) for key in numbers]
    rest = [axis for axis in FIGURES if "lenses.count" not in numbers or axis is not FIGURES[0]]
    return [axis for axis in [*swept, *rest] if len({axis.of(row) for row in question.found} - {None}) > 1]


def _upwards(question: Group) -> list[Axis]:
    own = Axis(question.quantity, lambda row: row.figure)
    others = [
        Axis("RMSE (mm)", lambda row: row.rmse),
        Axis("gap to the bound (% of the score)", lambda row: None if row.gap is None else 100 * row.gap),
        Axis("measured (share of the depths)", lambda row: row.measured),
    ]
    vary = [axis for axis in others if len({axis.of(row) for row in question.found} - {None}) > 1]
    return [own, *(axis for axis in vary if axis.words != own.words)]


def _lines(known: Sequence[SweepRow], rows: Sequence[SweepRow], right: Axis, up: Axis) -> list[Series]:
    keys = [key for key in varied(rows) if not is_asked(key) and key != right.key]
    names = short_names(varied(rows))
    lines = []
    for k, group in enumerate(grouped(known, keys)):
        ordered = sorted(group.rows, key=lambda row: _rounded(right, row))
        colour = LENS_COLOURS[k] if k < len(LENS_COLOURS) else RULE
        lines.append(Series(in_words(group.settings, names) or "jobs", colour, _points(ordered, right, up), "default"))
    return lines


def _front(known: Sequence[SweepRow], right: Axis, up: Axis) -> list[Series]:
    best = front([_rounded(right, row) for row in known], [_rounded(up, row) for row in known])
    others = [row for k, row in enumerate(known) if k not in set(best)]
    unbeaten = Series(UNBEATEN, FRONT, _points([known[k] for k in best], right, up), "steps-post")
    return [unbeaten, *([Series(BEATEN, OTHERS, _points(others, right, up), None)] if others else [])]


def _points(rows: Sequence[SweepRow], right: Axis, up: Axis) -> tuple[tuple[float, float, str], ...]:
    return tuple((_rounded(right, row), _rounded(up, row), where(row)) for row in rows)


def _rounded(axis: Axis, row: SweepRow) -> float:
    number = axis.of(row)
    assert number is not None
    return float(f"{number:.{DIGITS}g}")


def is_number(value: str) -> bool:
    """Whether a word is read as a number."""
    try:
        float(value)
    except ValueError:
        return False
    return True
