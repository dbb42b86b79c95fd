from pathlib import Path

import pytest

import multilens as ml
from benchmark.best_known import Entry, improved, load, save
from benchmark.problems import CASES, Case, fingerprint
from benchmark.referee import Judged
from multilens.certificate import certify
from multilens.records import read_layout

BY_NAME = {case.name: case for case in CASES}
STORED = load()


def test_every_entry_is_of_a_problem_there_is_as_it_is() -> None:
    assert all(entry.problem == fingerprint(BY_NAME[name].problem) for name, entry in STORED.items())


@pytest.mark.parametrize("name", STORED)
def test_an_entry_is_feasible_by_exact_arithmetic(name: str) -> None:
    problem = BY_NAME[name].problem
    layout = read_layout(STORED[name].layout, "layout", problem.lenses)
    assert certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap).feasible


@pytest.mark.parametrize("name", STORED)
def test_the_score_of_an_entry_is_what_its_layout_scores(name: str) -> None:
    problem = BY_NAME[name].problem
    score = problem.score(read_layout(STORED[name].layout, "layout", problem.lenses)).item()
    # Another machine, or the same formula in another order, rounds the last digits otherwise.
    assert score == pytest.approx(STORED[name].score, rel=1e-9)


@pytest.mark.parametrize("name", STORED)
def test_no_entry_is_below_what_is_proved(name: str) -> None:
    bound = ml.lower_bound(BY_NAME[name].problem, boxes=1).value
    assert bound is not None
    assert bound <= STORED[name].score


@pytest.fixture
def case() -> Case:
    return BY_NAME["2 rectangle"]


@pytest.mark.parametrize(("score", "kept"), [(2.5, 2.0), (1.5, 1.5)])
def test_an_entry_only_improves(case: Case, score: float, kept: float) -> None:
    before = {case.name: Entry(fingerprint(case.problem), 2.0, "somebody", [])}
    after = improved(before, case, [("another", Judged(1.0, score, []))])
    assert after[case.name].score == kept


def test_an_entry_of_a_problem_that_has_changed_is_replaced_even_by_a_worse_one(case: Case) -> None:
    before = {case.name: Entry("stale", 2.0, "somebody", [])}
    after = improved(before, case, [("another", Judged(1.0, 2.5, []))])
    assert after[case.name] == Entry(fingerprint(case.problem), 2.5, "another", [])


def test_what_is_saved_is_read_back(case: Case, tmp_path: Path) -> None:
    entries = {case.name: Entry(fingerprint(case.problem), 0.1 + 0.2, "somebody", [{"focus": [1.0]}])}
    save(entries, tmp_path / "best.json")
    assert load(tmp_path / "best.json") == entries
