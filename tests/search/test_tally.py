import torch

from multilens.search.tally import Tally


def test_without_fresh_starts_there_is_no_convergence() -> None:
    assert Tally().convergence is None


def test_waves_of_fewer_steps_are_filled_up_with_their_last() -> None:
    tally = Tally([torch.tensor([[3.0, 2.0]]), torch.tensor([[6.0, 5.0, 4.0]])], [1], [2.0])
    found = tally.convergence
    assert found is not None
    assert found.steps == (0, 1, 2)
    assert found.scores.tolist() == [[3.0, 2.0, 2.0], [6.0, 5.0, 4.0]]
    assert (found.polished, found.polished_scores) == ((1,), (2.0,))
