"""The comparison is fair and its result still holds: the peer's formulas are right, and the stored table is as claimed."""

import csv
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scipy.optimize import approx_fprime

STUDY = Path(__file__).parent


def load(name: str) -> ModuleType:
    spec = spec_from_file_location(name, STUDY / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


peer, run = load("peer"), load("run")


@pytest.fixture(params=run.PROBLEMS, ids=lambda problem: problem[0])
def rival(request: pytest.FixtureRequest) -> object:
    return peer.Peer(run.problem_of(request.param[1]))


def test_the_peer_minimises_what_the_library_scores(rival: object) -> None:
    start = rival.random_start(np.random.default_rng(1))
    score = rival.problem.score(rival.layout(start)).item()
    assert rival.objective(start)[0] == pytest.approx(score, rel=1e-12)


def test_the_peers_gradients_are_right(rival: object) -> None:
    start = rival.random_start(np.random.default_rng(2))
    value, gradient = rival.objective(start)
    difference = approx_fprime(start, lambda v: rival.objective(v)[0], 1e-7)
    np.testing.assert_allclose(gradient, difference, atol=1e-5 * abs(difference).max() + 1e-6 * value)
    rows = [approx_fprime(start, lambda v, k=k: rival.room(v)[k], 1e-7) for k in range(len(rival.room(start)))]
    np.testing.assert_allclose(rival.room_gradient(start), rows, atol=1e-3)


def test_nearly_every_run_of_the_peer_ends_feasible() -> None:
    scores, _ = run.peer_scores(run.problem_of(run.PROBLEMS[0][1]), 8)
    assert len(scores) >= 7


def test_the_search_is_never_behind_two_hundred_runs_and_ahead_on_the_demo() -> None:
    with (STUDY / "results" / "table.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["problem"] for row in rows] == [title for title, _ in run.PROBLEMS]
    ratio = [float(row["best SLSQP RMSE (mm)"]) / float(row["multilens RMSE (mm)"]) for row in rows]
    assert all(behind >= 1 for behind in ratio)
    assert ratio[0] > 1.02
    assert all(int(row["feasible SLSQP runs"]) >= 190 for row in rows)
