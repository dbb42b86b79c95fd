"""Which runs are asked for, of methods that find what the test says."""

from collections.abc import Callable

import pytest

from benchmark import schedule
from benchmark.best_known import Entry
from benchmark.lanes import Outcome
from benchmark.measures import Run
from benchmark.methods import OURS, RIVAL
from benchmark.problems import CASES, fingerprint
from benchmark.referee import Judged

CASE = next(case for case in CASES if case.name == "8 blob")
LIMIT = 10.0

Scheduled = Callable[[Callable[[str, float, float], tuple[float, float, float]]], list[Run]]


@pytest.fixture
def scheduled(monkeypatch: pytest.MonkeyPatch) -> Scheduled:
    """All runs where 1 is the best known score, given what a run finds: from method, limit and goal to when, score and end."""

    class Lanes:
        def __init__(self, found: Callable[[str, float, float], tuple[float, float, float]]) -> None:
            self.found = found

        def run(self, name: str, case: str, seed: int, limit: float, goal: float) -> Callable[[], Outcome]:
            at, score, end = self.found(name, limit, goal)
            return lambda: Outcome([Judged(at, score, [])], end, "")

    monkeypatch.setattr(schedule, "load", lambda: {CASE.name: Entry(fingerprint(CASE.problem), 1.0, "somebody", [])})
    return lambda found: schedule.everything(Lanes(found), [CASE], (0, 1, 2), LIMIT)[0]  # type: ignore[arg-type]


def limits_and_ends(runs: list[Run]) -> list[tuple[float, float]]:
    return [(run.limit, run.seconds) for run in runs if run.method == RIVAL]


def test_the_rival_may_go_on_until_two_of_its_runs_have_missed_the_aim(scheduled: Scheduled) -> None:
    runs = scheduled(lambda name, limit, goal: (2.0, 1.0 if name == OURS else 1.5, limit))
    longer = (1 + schedule.MARGIN) * 10 * 2.0
    assert limits_and_ends(runs) == [(longer, longer), (longer, longer), (LIMIT, LIMIT)]


def test_a_peer_may_stop_at_the_best_known(scheduled: Scheduled) -> None:
    runs = scheduled(lambda name, limit, goal: (0.1, 1.0, 0.1 if goal >= 1.0 else limit))
    assert limits_and_ends(runs) == [(LIMIT, 0.1)] * 3


def test_a_peer_that_stopped_at_what_is_beaten_now_runs_again_to_the_end(scheduled: Scheduled) -> None:
    def found(name: str, limit: float, goal: float) -> tuple[float, float, float]:
        return (0.1, 0.9, limit) if name == OURS else (0.1, 1.0, 0.1 if goal >= 1.0 else limit)

    assert limits_and_ends(scheduled(found)) == [(LIMIT, LIMIT)] * 3
