import pytest
import torch

import multilens as ml
from multilens.search.descent import DescentSettings, descend
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

SHORT = DescentSettings(steps=40)


def go_on(step: int, alive: int, best: float) -> bool:
    return True


def test_what_a_start_does_depends_on_no_other(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    x = scattered_starts(crowded, variables, 12, seed=0)
    price = ml.distance_penalty(crowded)
    together = descend(crowded, variables, price, x, SHORT, go_on)
    alone = descend(crowded, variables, price, x[5:6], SHORT, go_on)
    torch.testing.assert_close(together.x[5], alone.x[0], rtol=0, atol=1e-12)


def test_most_starts_end_nearly_feasible_and_better(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    x = scattered_starts(crowded, variables, 24, seed=0)
    price = ml.distance_penalty(crowded)
    before = crowded.score(variables.layout(x))
    ended = descend(crowded, variables, price, x, DescentSettings(steps=120), go_on)
    good = (ended.price < 1e-3) & (ended.score < before)
    assert good.double().mean().item() > 0.8


def test_vectors_keep_their_bounds(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    ended = descend(
        crowded, variables, ml.distance_penalty(crowded), scattered_starts(crowded, variables, 8, 0), SHORT, go_on
    )
    assert (ended.x >= 0).all()
    assert (ended.x <= variables.upper).all()


def test_a_start_that_fails_is_reported_and_harms_no_other() -> None:
    back, lens = ml.Back.rectangle(10, 10), ml.Lens(1.0, (0.5, 1.0))

    def score(layout: ml.Layout) -> torch.Tensor:
        # Not a number in the left half of the back.
        return -(layout.position[..., 0, 0] - 5).sqrt()

    problem = ml.ScoreProblem(back, [lens], score)
    variables = Variables(problem)
    x = variables.vector(ml.Layout([[[2.0, 5.0]], [[8.0, 5.0]]], [[0.5], [0.5]], [[1.0], [1.0]]))
    counts = []
    ended = descend(
        problem,
        variables,
        ml.distance_penalty(problem),
        x,
        SHORT,
        lambda step, alive, best: counts.append(alive) or True,
    )
    assert ended.score.isnan().tolist() == [True, False]
    assert counts[-1] == 1


@pytest.mark.parametrize("terms", [1, 3])
def test_a_score_of_zero_is_no_failure(terms: int) -> None:
    # Both starts run to the left rim, where the score is 0, and the first is there from the beginning.
    def score(layout: ml.Layout) -> torch.Tensor:
        return layout.position[..., :1, 0].expand(*layout.position.shape[:-2], terms)

    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], score)
    variables = Variables(problem)
    x = variables.vector(ml.Layout([[[0.0, 5.0]], [[6.0, 5.0]]], [[0.5], [0.5]], [[1.0], [1.0]]))
    ended = descend(problem, variables, ml.distance_penalty(problem), x, DescentSettings(steps=240), go_on)
    assert ended.score.isfinite().tolist() == [True, True]


def test_it_stops_when_told(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    x = scattered_starts(crowded, variables, 4, 0)
    ended = descend(crowded, variables, ml.distance_penalty(crowded), x, SHORT, lambda step, alive, best: step < 10)
    assert ended.history_steps[-1] == 10


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_change_nothing(crowded: ml.Problem, threads: int) -> None:
    variables = Variables(crowded, torch.float32)
    x = scattered_starts(crowded, Variables(crowded), 64, 0).float()
    used = torch.get_num_threads()
    try:
        torch.set_num_threads(threads)
        ended = descend(crowded, variables, ml.distance_penalty(crowded), x, SHORT, go_on)
        torch.set_num_threads(1)
        once = descend(crowded, variables, ml.distance_penalty(crowded), x, SHORT, go_on)
    finally:
        torch.set_num_threads(used)
    assert torch.equal(ended.x, once.x)
