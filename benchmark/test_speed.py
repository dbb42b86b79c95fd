import pytest
import torch

from benchmark.speed import BEST, plain_score, question, random_layouts, speed_table, value_and_gradient


@pytest.fixture
def pair() -> tuple:
    problem = question(4, 32)
    return problem, random_layouts(problem, 6, {"dtype": torch.float64, "device": "cpu"})


def test_the_plain_objective_is_the_librarys(pair: tuple) -> None:
    problem, layout = pair
    torch.testing.assert_close(plain_score(problem, layout), problem.score(layout), rtol=1e-9, atol=0)


def test_the_plain_gradient_is_the_librarys(pair: tuple) -> None:
    problem, layout = pair
    ours, plain = (
        value_and_gradient(score, layout) for score in (problem.score, lambda each: plain_score(problem, each))
    )
    for one, other in zip(ours, plain, strict=True):
        torch.testing.assert_close(one, other, rtol=1e-9, atol=1e-12)


def test_the_last_row_has_the_best_batch_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    rates = {2: [100.0, 20.0], 4: [300.0, 10.0]}
    monkeypatch.setattr("benchmark.speed._rates", lambda batch, kind: rates[batch])
    rows = speed_table(batches=(2, 4))
    assert [row[2:] for row in rows[1:4]] == [[2, 100.0, 20.0, 5.0], [4, 300.0, 10.0, 30.0], [BEST, 300.0, 20.0, 15.0]]
