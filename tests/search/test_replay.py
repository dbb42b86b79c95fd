"""Starts settled once more, for whoever wants to watch."""

import pytest
import torch

import multilens as ml
from multilens.certificate import certify
from multilens.search.replay import replay


@pytest.fixture(scope="module")
def pair() -> ml.Problem:
    lens = ml.Lens(5.0, (1.0, 1.0), (200, 2000), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    return ml.Problem(ml.Back.rectangle(40, 40), [lens] * 2, ml.log_depths(300, 2000, 24), cues=[ml.PairStereo()])


def test_the_scores_are_those_of_the_layouts(crowded: ml.Problem):
    found = ml.solve(crowded, starts=4, patience=0, proof=0).layout
    again = replay(crowded, found, starts=4)
    # Alike are the first lens and none: no lens of another kind may take the place of one.
    assert again.layouts.position.shape[:2] == again.scores.shape
    torch.testing.assert_close(again.scores[1, 5], crowded.score(again.layouts[1][5]))


def test_the_chosen_start_ends_where_two_lenses_are_as_far_apart_as_can_be(pair: ml.Problem):
    found = ml.solve(pair, starts=4, patience=0, proof=0)
    again = replay(pair, found.layout, starts=8)
    end = again.layouts[again.chosen][-1]
    apart = (end.position[0] - end.position[1]).norm().item()
    assert apart == pytest.approx(36 * 2**0.5, rel=1e-3)
    assert again.scores[again.chosen, -1] < again.scores[again.chosen, 0]
    # The barrier leaves a thousandth of room to the last step.
    tightest = certify(pair.back, pair.lenses, pair.focus_range, end, pair.gap).tightest
    assert tightest.room > -1e-2


def test_lenses_that_are_alike_are_numbered_as_those_that_were_found(pair: ml.Problem):
    found = ml.solve(pair, starts=4, patience=0, proof=0).layout
    for numbered in (found, found.only([1, 0])):
        again = replay(pair, numbered, starts=4)
        apart = torch.cdist(numbered.position, again.layouts[again.chosen][-1].position)
        assert apart.diagonal().sum() <= apart.flip(0).diagonal().sum()


def test_the_same_seed_is_the_same_way(pair: ml.Problem):
    found = ml.solve(pair, starts=4, patience=0, proof=0).layout
    first, second = (replay(pair, found, starts=4, seed=3).layouts.position for _ in range(2))
    assert torch.equal(first, second)


@pytest.mark.parametrize("starts", [0, 65])
def test_starts_are_held_to_their_range(starts: int, pair: ml.Problem):
    with pytest.raises(ValueError, match="starts must be from 1 to 64"):
        replay(pair, ml.Layout([[5, 5], [30, 30]], [1, 1], [500, 500]), starts=starts)
