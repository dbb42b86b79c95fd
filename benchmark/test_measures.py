from math import inf, isnan

import numpy as np
import pytest

from benchmark.curves import median_curve
from benchmark.measures import Run, best_at, is_settled, median_of, stopped_too_early, time_to, times_shorter
from benchmark.referee import Judged


def run(*found: tuple[float, float]) -> Run:
    return Run("a", "b", 0, 10.0, 10.0, tuple(Judged(seconds, score, []) for seconds, score in found))


def test_the_best_score_after_a_time() -> None:
    assert [best_at(run((1.0, 5.0), (2.0, 4.0)), time) for time in (0.5, 1.0, 1.5, 2.0)] == [inf, 5.0, 5.0, 4.0]


def test_the_time_to_a_score() -> None:
    assert [time_to(run((1.0, 5.0), (2.0, 4.0)), score) for score in (6.0, 4.5, 3.0)] == [1.0, 2.0, inf]


def test_what_comes_long_after_the_limit_does_not_count() -> None:
    assert time_to(run((11.0, 5.0)), 6.0) == inf


@pytest.mark.parametrize(("numbers", "middle"), [([3.0, 1.0, 2.0], 2.0), ([1.0, inf], inf), ([1.0, inf, inf], inf)])
def test_the_median_of_times_of_which_some_are_never(numbers: list[float], middle: float) -> None:
    assert median_of(numbers) == middle


@pytest.mark.parametrize(("ours", "theirs", "times"), [(1.0, 5.0, 5.0), (2.0, inf, 5.0), (inf, 5.0, 0.0)])
def test_how_many_times_shorter(ours: float, theirs: float, times: float) -> None:
    assert times_shorter(ours, theirs, 10.0) == times


def test_where_neither_got_there_no_time_is_shorter() -> None:
    assert isnan(times_shorter(inf, inf, 10.0))


def test_the_median_curve_begins_when_most_runs_have_something() -> None:
    times, scores = median_curve([run((1.0, 5.0)), run((2.0, 3.0)), run((3.0, 4.0))], 10.0)
    np.testing.assert_array_equal(times[:-1], [2.0, 3.0])
    np.testing.assert_array_equal(scores[:-1], [5.0, 4.0])


@pytest.mark.parametrize(
    ("times", "settled"), [([], False), ([inf, 1.0], False), ([inf, inf], True), ([1.0, 2.0], False)]
)
def test_the_median_of_three_is_settled_once_two_never_got_there(times: list[float], settled: bool) -> None:
    assert is_settled(times, 3) == settled


@pytest.mark.parametrize(
    ("method", "seconds", "score", "early"),
    [
        ("SLSQP", 3.0, 1.0, False),
        ("SLSQP", 3.0, 1.01, True),
        ("SLSQP", 10.0, 1.01, False),
        ("multilens", 3.0, 1.01, False),
    ],
)
def test_a_peer_that_stopped_short_of_what_is_the_best_known_now_stopped_too_early(
    method: str, seconds: float, score: float, early: bool
) -> None:
    ended = Run("a", method, 0, 10.0, seconds, (Judged(1.0, score, []),))
    assert stopped_too_early(ended, 1.0) == early
