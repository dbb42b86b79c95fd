from benchmark.lanes import Outcome, together
from benchmark.referee import Judged


def test_two_runs_together_have_at_each_time_what_the_better_one_has() -> None:
    first = Outcome([Judged(1.0, 5.0, []), Judged(4.0, 2.0, [])], 9.0, "")
    second = Outcome([Judged(2.0, 3.0, []), Judged(3.0, 2.5, []), Judged(5.0, 2.2, [])], 10.0, "ended early")
    both = together([first, second])
    assert [(each.seconds, each.score) for each in both.judged] == [(1.0, 5.0), (2.0, 3.0), (3.0, 2.5), (4.0, 2.0)]
    assert (both.seconds, both.failure) == (10.0, "ended early")
