"""The tables of a benchmark, and what they say about the project's own aims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite, isnan
from statistics import median
from typing import Any

from benchmark.best_known import Entry
from benchmark.measures import CLOSE, TIE, VERY_CLOSE, Run, best_at, excess, final, median_of, time_to, times_shorter
from benchmark.methods import OURS, PEERS, RIVAL
from benchmark.problems import Case
from benchmark.speed import BEST
from multilens.table_text import markdown_text

TIMES = (1.0, 3.0, 10.0)
"""s; at which the best score is shown."""

LEAST_RATIO = {"N >= 8": 10.0, "N = 4 to 6": 3.0, "N = 2, 3": 1.0}
"""Times that the search must be faster than the rival, by the number of lenses."""

LENSES = {"N >= 8": range(8, 100), "N = 4 to 6": range(4, 8), "N = 2, 3": range(1, 4)}
"""Numbers of lenses of each group."""

WORST_GAP = 0.005
"""Part of the best known score: the gap that is allowed at the limit."""

CONVEX_GAP, MEDIAN_GAP, EAGER_RATIO, VERTEX_GROWTH, MOST_TIMES = 0.10, 0.20, 20.0, 0.10, 3.0


@dataclass(frozen=True)
class Bound:
    """A proved lower bound of a problem.

    Args:
        value: mm^2, or None where none is known.
        reason: why there is none.
        seconds: it took.
    """

    value: float | None
    reason: str
    seconds: float


@dataclass(frozen=True)
class Results:
    """Everything that a benchmark has measured.

    Args:
        cases: that were run.
        runs: of all methods.
        best: best known score of each case, mm^2, these runs included.
        limit: at which scores are compared, s; the rival's runs may go on beyond it.
        bounds: by the names of the cases; empty where none were asked for.
        speed: rows of the table of evaluations, head first; empty likewise.
        growth: rows of the table of growth, head first; empty likewise.
        cues: rows of the table of other cues, head first; empty likewise.
    """

    cases: Sequence[Case]
    runs: Sequence[Run]
    best: Mapping[str, Entry]
    limit: float
    bounds: Mapping[str, Bound]
    speed: Sequence[Sequence[Any]]
    growth: Sequence[Sequence[Any]]
    cues: Sequence[Sequence[Any]] = ()

    def of(self, case: str, method: str) -> list[Run]:
        """Give the runs of a method on a case that did not fail."""
        return [run for run in self.runs if run.case == case and run.method == method and not run.failure]

    def median_final(self, case: str, method: str) -> float:
        """Give the median over the seeds of the score at the limit, mm^2; infinity where there is none."""
        return median_of([final(run, self.limit) for run in self.of(case, method)] or [inf])

    def median_time(self, case: str, method: str, share: float) -> float:
        """Give the median over the seeds of the time to within a part of the best known score, s, or infinity."""
        target = self.best[case].score * (1 + share)
        return median_of([time_to(run, target) for run in self.of(case, method)] or [inf])

    def longest(self, case: str, method: str) -> float:
        """Give the limit of a method's runs on a case, s."""
        return max((run.limit for run in self.of(case, method)), default=self.limit)


def aimed_ratio(case: Case) -> float:
    """Give how many times faster than the rival the search shall be on a case."""
    return next(LEAST_RATIO[group] for group, counts in LENSES.items() if len(case.problem.lenses) in counts)


def table(results: Results) -> list[list[Any]]:
    """Give a row for each problem and method, head first; medians over the seeds; what was never reached is "> limit"."""
    shown = [time for time in TIMES if time <= results.limit]
    rows: list[list[Any]] = [
        [
            "problem",
            "method",
            "runs",
            *(f"score at {time:g} s (mm^2)" for time in shown),
            f"above best known at {results.limit:g} s (%)",
            "time to within 1 % (s)",
            "time to within 0.1 % (s)",
            "remark",
        ]
    ]
    for case in results.cases:
        for method in (OURS, *PEERS):
            of_method = [run for run in results.runs if run.case == case.name and run.method == method]
            if not of_method:
                continue
            scores = [
                median_of([final(run, time) if time == results.limit else best_at(run, time) for run in of_method])
                for time in shown
            ]
            above = 100 * excess(results.median_final(case.name, method), results.best[case.name].score)
            rows.append(
                [
                    case.name,
                    method,
                    len(of_method),
                    *(score if isfinite(score) else "none" for score in scores),
                    round(above, 4) if isfinite(above) else "none",
                    *(
                        _shown_time(results.median_time(case.name, method, share), results.longest(case.name, method))
                        for share in (CLOSE, VERY_CLOSE)
                    ),
                    "; ".join(sorted({run.failure for run in of_method} - {""})),
                ]
            )
    return rows


def summary(results: Results) -> str:
    """Give the page that holds the figures against the project's aims."""
    limit = results.limit
    seeds = sorted({run.seed for run in results.runs if run.method == OURS})
    page = [
        "# What the benchmark says",
        "",
        f"{len(results.cases)} problems, scores after {limit:g} s; medians over the seeds {', '.join(map(str, seeds))}.",
        f"A time ratio is the time of {RIVAL}, on both cores, to within 0.1 % of the best known score over that of {OURS}.",
        f"{RIVAL} may go on until its time shows whether the aim is kept; that limit stands for it where it never is (>=).",
        "",
        "## Aims",
        "",
        markdown_text([["aim", "measured", "verdict"], *_aims(results)]),
        "## Problem by problem",
        "",
        markdown_text(_comparison(results)),
        'A bound is a score below which no layout can come; "below" is how far it lies below the best known score.',
        "",
    ]
    tables = (("Value and gradient", results.speed), ("Growth", results.growth), ("Other cues", results.cues))
    for title, rows in tables:
        if rows:
            page += [f"## {title}", "", markdown_text(rows)]
    return "\n".join(page)


def _aims(results: Results) -> list[list[str]]:
    rows = [_ratio_aim(results, group, least) for group, least in LEAST_RATIO.items() if _group(results, group)]
    beaten = [case.name for case in results.cases if not _is_best(results, case.name)]
    rows.append(
        [
            f"the best score of all methods at {results.limit:g} s on every problem",
            f"on {len(results.cases) - len(beaten)} of {len(results.cases)}"
            + (f"; not on: {'; '.join(beaten)}" if beaten else ""),
            _verdict(not beaten),
        ]
    )
    gaps = {case.name: _gap(results, case.name, OURS) for case in results.cases}
    worst = max(gaps, key=lambda name: gaps[name])
    rows.append(
        [
            f"worst gap to the best known at most {WORST_GAP:.1%}",
            f"{gaps[worst]:.2%} ({worst})",
            _verdict(gaps[worst] <= WORST_GAP),
        ]
    )
    return rows + _bound_aims(results) + _speed_aims(results)


def _ratio_aim(results: Results, group: str, least: float) -> list[str]:
    ratios = {case.name: _ratio(results, case.name) for case in _group(results, group)}
    # Where neither got there nothing is won: it counts as a failure.
    told = {name: 0.0 if isnan(ratio) else ratio for name, ratio in ratios.items()}
    worst = min(told, key=lambda name: told[name])
    return [
        f"time to within 0.1 % at least {least:g} times shorter than {RIVAL}, {group}",
        f"median {median(told.values()):.3g}, least {told[worst]:.3g} ({worst})",
        _verdict(told[worst] >= least),
    ]


def _bound_aims(results: Results) -> list[list[str]]:
    gaps = {case: _bound_gap(results, case.name) for case in results.cases if case.name in results.bounds}
    if not gaps:
        return []
    every = [inf if gap is None else gap for gap in gaps.values()]
    small = [inf if gap is None else gap for case, gap in gaps.items() if case.convex and len(case.problem.lenses) <= 4]
    rows = [
        [
            f"median over the problems of the certified gap at most {MEDIAN_GAP:.0%}",
            _shown_gap(median(every)),
            _verdict(median(every) <= MEDIAN_GAP),
        ]
    ]
    if small:
        worst = max(small)
        rows.append(
            [
                f"certified gap at most {CONVEX_GAP:.0%} on convex backs with N <= 4",
                f"worst of {len(small)}: {_shown_gap(worst)}",
                _verdict(worst <= CONVEX_GAP),
            ]
        )
    return rows


def _speed_aims(results: Results) -> list[list[str]]:
    rows = []
    for name, *_, ratio in (row for row in results.speed[1:] if row[2] == BEST):
        equal = "; ".join(f"{row[2]}: {row[-1]:.3g}" for row in results.speed[1:] if row[0] == name and row[2] != BEST)
        rows.append(
            [
                f"value and gradient at least {EAGER_RATIO:g} times the rate of plain eager torch, each at its best batch, "
                f"{name} (N = 8, 128 depths)",
                f"{ratio:.3g} (equal batches: {equal})",
                _verdict(ratio >= EAGER_RATIO),
            ]
        )
    growth = [row for row in results.growth[1:] if row[0] == "outline vertices"]
    if growth:
        times = growth[-1][2] / growth[0][2]
        rows.append(
            [
                f"time of a search step on {growth[-1][1]} vertices within {VERTEX_GROWTH:.0%} of that on {growth[0][1]}",
                f"{times:.3g} times",
                _verdict(times <= 1 + VERTEX_GROWTH),
            ]
        )
    for name, _, times, *_ in results.cues[2:]:
        rows.append(
            [
                f"search of four lenses by {name} cues at most {MOST_TIMES:g} times as long as by the thesis' cues",
                f"{times:.3g} times",
                _verdict(times <= MOST_TIMES),
            ]
        )
    return rows


def _comparison(results: Results) -> list[list[Any]]:
    methods = [method for method in PEERS if any(run.method == method for run in results.runs)]
    rows: list[list[Any]] = [
        [
            "problem",
            "best known (mm^2)",
            "found by",
            f"{OURS}: to 0.1 % (s)",
            f"{RIVAL}: to 0.1 % (s)",
            "time ratio",
            *(f"{method} above best known (%)" for method in (OURS, *methods)),
            "bound below (%)",
            "time of the bound (s)",
        ]
    ]
    for case in results.cases:
        ours, theirs = (results.median_time(case.name, method, VERY_CLOSE) for method in (OURS, RIVAL))
        gap = _bound_gap(results, case.name)
        bound = results.bounds.get(case.name)
        rows.append(
            [
                case.name,
                f"{results.best[case.name].score:.7g}",
                results.best[case.name].found_by,
                _shown_time(ours, results.longest(case.name, OURS)),
                _shown_time(theirs, results.longest(case.name, RIVAL)),
                _shown_ratio(_ratio(results, case.name), theirs == inf),
                *(_shown_share(_gap(results, case.name, method)) for method in (OURS, *methods)),
                f"{100 * gap:.1f}" if gap is not None else (f"none: {bound.reason}" if bound else "not asked"),
                f"{bound.seconds:.1f}" if bound else "",
            ]
        )
    return rows


def _group(results: Results, group: str) -> list[Case]:
    return [case for case in results.cases if len(case.problem.lenses) in LENSES[group]]


def _ratio(results: Results, case: str) -> float:
    ours, theirs = (results.median_time(case, method, VERY_CLOSE) for method in (OURS, RIVAL))
    return times_shorter(ours, theirs, results.longest(case, RIVAL))


def _gap(results: Results, case: str, method: str) -> float:
    return excess(results.median_final(case, method), results.best[case].score)


def _is_best(results: Results, case: str) -> bool:
    least = min(results.median_final(case, method) for method in PEERS)
    return results.median_final(case, OURS) <= least * (1 + TIE)


def _bound_gap(results: Results, case: str) -> float | None:
    bound = results.bounds.get(case)
    return None if bound is None or bound.value is None else 1 - bound.value / results.best[case].score


def _verdict(kept: bool) -> str:
    return "pass" if kept else "falls short"


def _shown_time(seconds: float, limit: float) -> str:
    return f"{seconds:.2f}" if seconds < inf else f"> {limit:g}"


def _shown_ratio(ratio: float, never: bool) -> str:
    if isnan(ratio):
        return "neither"
    return f"{'>= ' if never and ratio else ''}{ratio:.3g}"


def _shown_share(share: float) -> str:
    return f"{100 * share:.3g}" if share < inf else "none"


def _shown_gap(gap: float) -> str:
    return f"{gap:.1%}" if gap < inf else "no bound known"
