from collections.abc import Callable

import pytest

from benchmark.best_known import Entry
from benchmark.measures import Run
from benchmark.methods import OURS, RIVAL
from benchmark.problems import CASES
from benchmark.referee import Judged
from benchmark.report import Bound, Results, summary, table
from benchmark.speed import BEST

CASE = next(case for case in CASES if case.name == "8 rectangle")

Made = Callable[..., Results]


@pytest.fixture
def made() -> Made:
    """Results of one problem with the best known score 1: ours and the rival's time to it in s, None for never."""

    def results(
        ours: float | None, theirs: float | None, failure: str = "", bound: float | None = None, ratio: float = 25.0
    ) -> Results:
        def run(method: str, seed: int, seconds: float | None) -> Run:
            found = [Judged(0.1, 2.0, [])] + ([] if seconds is None else [Judged(seconds, 1.0, [])])
            return Run(CASE.name, method, seed, 10.0, 10.0, tuple(found))

        runs = [run(method, seed, time) for method, time in ((OURS, ours), (RIVAL, theirs)) for seed in range(3)]
        if failure:
            runs.append(Run(CASE.name, "CMA-ES", 0, 10.0, 0.0, (), failure))
        best = {CASE.name: Entry("", 1.0, "somebody", [])}
        bounds = {CASE.name: Bound(bound, "for the test", 0.0)}
        speed = [["type", "device", "batch", "ratio"], ["float64", "cpu", 256, 50.0], ["float64", "cpu", BEST, ratio]]
        growth = [["grows", "to", "us"], ["outline vertices", 20, 2.0], ["outline vertices", 2000, 2.1]]
        cues = [
            ["cues", "time", "times", "above", "worst"],
            ["thesis", 8.0, 1.0, 0, 0],
            ["photometric", 16.0, 2.0, 0, 0],
        ]
        return Results([CASE], runs, best, 10.0, bounds, speed, growth, cues)

    return results


def row(page: str, begin: str) -> str:
    return next(line for line in page.splitlines() if line.startswith(f"| {begin}"))


def test_a_row_of_the_table_holds_medians_of_score_and_time(made: Made) -> None:
    head, first, *_ = table(made(0.5, 5.0))
    shown = dict(zip(head, first, strict=True))
    assert shown["score at 1 s (mm^2)"] == 1.0
    assert shown["above best known at 10 s (%)"] == 0.0
    assert shown["time to within 0.1 % (s)"] == "0.50"


def test_what_was_never_reached_is_more_than_the_limit(made: Made) -> None:
    head, _, rival = table(made(0.5, None))
    shown = dict(zip(head, rival, strict=True))
    assert shown["time to within 0.1 % (s)"] == "> 10"
    assert shown["above best known at 10 s (%)"] == 100.0


def test_a_failure_is_shown(made: Made) -> None:
    head, *_, failed = table(made(0.5, 5.0, failure="not run: no cma"))
    assert dict(zip(head, failed, strict=True))["remark"] == "not run: no cma"


@pytest.mark.parametrize(
    ("ours", "theirs", "verdict"),
    [(0.5, 5.0, "pass"), (0.6, 5.0, "falls short"), (0.5, None, "pass"), (None, None, "falls short")],
)
def test_ten_times_faster_is_a_pass(made: Made, ours: float | None, theirs: float | None, verdict: str) -> None:
    assert row(summary(made(ours, theirs)), "time to within 0.1 % at least 10 times").endswith(f"{verdict} |")


def test_a_ratio_to_a_rival_that_never_got_there_is_a_least_one(made: Made) -> None:
    assert "| >= 20 |" in row(summary(made(0.5, None)), CASE.name)


@pytest.mark.parametrize(("ours", "verdict"), [(5.0, "pass"), (None, "falls short")])
def test_the_best_score_of_all_is_a_pass(made: Made, ours: float | None, verdict: str) -> None:
    assert row(summary(made(ours, 5.0)), "the best score of all methods").endswith(f"{verdict} |")


@pytest.mark.parametrize(("bound", "verdict"), [(0.85, "pass"), (0.7, "falls short"), (None, "falls short")])
def test_the_certified_gap_is_held_against_its_aim(made: Made, bound: float | None, verdict: str) -> None:
    assert row(summary(made(0.5, 5.0, bound=bound)), "median over the problems").endswith(f"{verdict} |")


@pytest.mark.parametrize(("ratio", "verdict"), [(25.0, "pass"), (15.0, "falls short")])
def test_the_rate_is_held_against_its_aim_each_at_its_best_batch(made: Made, ratio: float, verdict: str) -> None:
    assert row(summary(made(0.5, 5.0, ratio=ratio)), "value and gradient").endswith(f"{verdict} |")


def test_the_time_of_other_cues_is_held_against_its_aim(made: Made) -> None:
    assert row(summary(made(0.5, 5.0)), "search of four lenses by photometric cues").endswith("| 2 times | pass |")
