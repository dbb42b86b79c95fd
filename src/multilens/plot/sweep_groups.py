"""The rows of a sweep in groups that can be compared, and short names for what was swept."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

from multilens.sweep_row import SweepRow, in_order

ASKED = ("experiment", "depth", "field_of_view", "cues", "scene", "metric", "fusion", "robust", "tolerance")
"""First parts of the keys that say what is asked of a device, not what it is: errors under different ones compare nothing."""

LONGEST = 24
"""Letters of a value; a longer one loses its middle."""

WORDS_EACH = 6
"""Jobs without a design that are named one by one."""


@dataclass(frozen=True)
class Group:
    """Rows that have some settings in common.

    Args:
        settings: by which they were grouped, keys and values.
        rows: in the order of the sweep.
    """

    settings: tuple[tuple[str, str], ...]
    rows: tuple[SweepRow, ...]

    @property
    def found(self) -> tuple[SweepRow, ...]:
        """The rows that have a figure."""
        return tuple(row for row in self.rows if row.figure is not None)

    @property
    def quantity(self) -> str:
        """What the figures are, with their unit, such as RMSE (mm)."""
        first = self.found[0]
        return "score" if first.metric is None else f"{first.metric} ({first.unit})"


def varied(rows: Iterable[SweepRow]) -> dict[str, tuple[str, ...]]:
    """Give the keys that have more than one value, each with its values in order: numbers by size, words as they come."""
    values: dict[str, dict[str, None]] = {}
    for row in rows:
        for key, value in row.settings:
            values.setdefault(key, {})[value] = None
    return {key: tuple(in_order(each)) for key, each in values.items() if len(each) > 1}


def is_asked(key: str) -> bool:
    """Whether a key belongs to what is asked of a device."""
    return key.lstrip("+~").partition(".")[0].partition("@")[0] in ASKED


def grouped(rows: Sequence[SweepRow], keys: Sequence[str]) -> tuple[Group, ...]:
    """Group rows by their values of some keys, the groups in the order of those values; rows that lack one are left out."""
    order = {key: {value: k for k, value in enumerate(values)} for key, values in varied(rows).items()}
    groups: dict[tuple[tuple[str, str], ...], list[SweepRow]] = {}
    for row in rows:
        given = dict(row.settings)
        if all(key in given for key in keys):
            groups.setdefault(tuple((key, given[key]) for key in keys), []).append(row)
    ranked = sorted(groups, key=lambda each: [order[key][value] if key in order else 0 for key, value in each])
    return tuple(Group(settings, tuple(groups[settings])) for settings in ranked)


def questions(rows: Sequence[SweepRow]) -> tuple[Group, ...]:
    """Group rows by what was asked, so that the errors of a group compare; groups in which nothing was found are left out.

    Errors in unlike units never share a group. A job that found nothing has none and is in the first group of its settings.
    """
    groups: list[Group] = []
    for group in grouped(rows, [key for key in varied(rows) if is_asked(key)]):
        kinds = list(dict.fromkeys((row.metric, row.unit) for row in group.found))
        for kind in kinds:
            same = [
                row for row in group.rows if (row.metric, row.unit) == kind or (row.figure is None and kind == kinds[0])
            ]
            groups.append(Group(group.settings, tuple(same)))
    return tuple(groups)


def figure_of(row: SweepRow) -> float:
    """Give the figure of a row that has one."""
    assert row.figure is not None
    return row.figure


def bound_figure(row: SweepRow) -> float | None:
    """Give a row's bound as its metric quotes it, in the unit of the figure; None where none is known.

    Every metric's figure is the root of its score, or a fixed part of it: the bound goes as sqrt(bound / score).
    """
    if row.bound is None or row.bound < 0 or row.figure is None or not row.score:
        return None
    return row.bound if row.metric is None else row.figure * sqrt(row.bound / row.score)


def short_names(keys: Iterable[str]) -> dict[str, str]:
    """Give for each key as much of its end as no other ends with, an index not alone: count for lenses.count, f_number.0."""
    parts = {key: key.lstrip("+~").split(".") for key in keys}
    names = {}
    for key, own in parts.items():
        others = [each for other, each in parts.items() if other != key]
        told = (k for k in range(1, len(own)) if not own[-k].isdecimal())
        fewest = next((k for k in told if all(each[-k:] != own[-k:] for each in others)), len(own))
        names[key] = ".".join(own[-fewest:])
    return names


def shortened(words: str, longest: int = LONGEST) -> str:
    """Take the middle out of words that are longer than so many letters."""
    if len(words) <= longest:
        return words
    kept = longest - 1
    return f"{words[: kept - kept // 2]}…{words[len(words) - kept // 2 :]}"


def in_words(settings: Iterable[tuple[str, str]], names: Mapping[str, str]) -> str:
    """Say settings by short names: count 3, depth room."""
    return ", ".join(f"{names[key]} {shortened(value)}" for key, value in settings)


def without_design(rows: Sequence[SweepRow]) -> str:
    """Say which jobs found nothing, and why in one word each; nothing where all found a design."""
    none = [row for row in rows if row.figure is None]
    if len(none) <= WORDS_EACH:
        jobs = ", ".join(f"job {row.job} ({row.status})" for row in none)
    else:
        kinds = {row.status: sum(other.status == row.status for other in none) for row in none}
        jobs = f"{len(none)} of {len(rows)} jobs ({', '.join(f'{n} {status}' for status, n in kinds.items())})"
    return f"without a design: {jobs}" if jobs else ""


def left_out(number: int, what: str) -> str:
    """Say how much there is no room for; nothing where there is room for all."""
    return f"left out: {number} {what}" if number else ""


def quantity_of(groups: Iterable[Group]) -> str:
    """Give what the figures of several groups are, such as RMSE (mm); error where they differ."""
    kinds = {group.quantity for group in groups}
    return kinds.pop() if len(kinds) == 1 else "Error"
