import pytest

from benchmark.found import Found, Notebook, OverError, Task
from benchmark.peers.model import Model
from benchmark.problems import CASES
from benchmark.referee import judge
from multilens.records import layout_record

PROBLEM = next(case for case in CASES if case.name == "2 rectangle").problem


def layout(x: float) -> list:
    import multilens as ml

    return layout_record(ml.Layout([[20.0, 20.0], [x, 120.0]], [1.0, 1.0], [300.0, 900.0]), PROBLEM.lenses)


def test_a_layout_off_the_back_does_not_count() -> None:
    assert judge(PROBLEM, [Found(0.1, 1e-3, layout(69.0))]) == []


def test_a_layout_that_fits_counts_with_the_librarys_score_whatever_was_claimed() -> None:
    (judged,) = judge(PROBLEM, [Found(0.1, 1e-3, layout(50.0))])
    position = judged.layout
    from multilens.records import read_layout

    assert judged.score == PROBLEM.score(read_layout(position, "layout", PROBLEM.lenses)).item()


def test_what_is_no_better_is_left_out() -> None:
    worse = layout(40.0)
    judged = judge(PROBLEM, [Found(0.1, 3.0, layout(50.0)), Found(0.2, 2.0, worse), Found(0.3, 1.0, layout(55.0))])
    assert [each.seconds for each in judged] == [0.1, 0.3]


def test_a_notebook_keeps_steps_worth_telling_and_the_last() -> None:
    now = iter(range(100))
    notebook = Notebook(Task(PROBLEM, 0, 0.0, 1e9), lambda: next(now))
    model = Model(PROBLEM)
    start = model.upper / 2
    for score in (3.0, 2.0, 2.5, 2.0 - 1e-6, 2.0 - 2e-6):
        notebook.tell(score, lambda: model.layout(start))
    assert [each.score for each in notebook.all()] == [3.0, 2.0, 2.0 - 2e-6]


def test_a_notebook_stops_a_run_at_the_limit() -> None:
    notebook = Notebook(Task(PROBLEM, 0, 5.0, 10.0), lambda: 15.0)
    with pytest.raises(OverError):
        notebook.refuse_after_the_end()


def test_a_notebook_stops_a_run_at_its_goal() -> None:
    notebook = Notebook(Task(PROBLEM, 0, 0.0, 10.0, goal=2.0), lambda: 1.0)
    stopped, model = [], Model(PROBLEM)
    for score in (3.0, 2.0):
        notebook.tell(score, lambda: model.layout(model.upper / 2))
        stopped.append(notebook.over)
    assert stopped == [False, True]
