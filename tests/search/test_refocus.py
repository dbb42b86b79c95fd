from dataclasses import replace
from itertools import product
from typing import Any

import pytest
import torch
from torch import Tensor

import multilens as ml
from multilens.search.refocus import VALUES, refocus
from multilens.search.variables import Variables


class Own:
    """Defocus as a cue of one's own: every value is tried by asking for its errors."""

    def measurements(self, lenses):
        return ml.LensDefocus().measurements(lenses)

    def __call__(self, layout, lenses, depths):
        return ml.LensDefocus()(layout, lenses, depths)


@pytest.fixture
def equal_lenses() -> ml.Problem:
    """Two fixed equal apertures from 0.2 to 2 m, defocus alone: weighted k-means in one dimension."""
    lenses = [ml.Lens(1000.0, (0.5, 0.5), position=(x, 5.0)) for x in (2.0, 8.0)]
    return ml.Problem(ml.Back.rectangle(10, 10), lenses, ml.linear_depths(200, 2000, 601), cues=[ml.LensDefocus()])


def with_own_cue(problem: ml.Problem) -> ml.Problem:
    cues = [Own() if isinstance(cue, ml.LensDefocus) else cue for cue in problem.cues]
    return ml.Problem(problem.back, problem.lenses, problem.depths, problem.weights, cues, problem.gap)


def drawn(problem: ml.Problem, generator: torch.Generator, count: int = 6) -> tuple[Variables, Tensor]:
    variables = Variables(problem)
    x = torch.rand(count, len(variables), generator=generator, dtype=torch.float64) * variables.upper
    return variables, variables.spread(x)


def in_order(variables: Variables) -> Tensor:
    return torch.arange(len(variables.low) - variables.focus_start, dtype=torch.float64)


@pytest.mark.parametrize("own", [False, True], ids=["closed form", "own cue"])
def test_foci_leave_a_rut(equal_lenses: ml.Problem, own: bool, truths: dict[str, Any]) -> None:
    problem = with_own_cue(equal_lenses) if own else equal_lenses
    variables = Variables(problem)
    # Both lenses near by: no gradient moves a focus past the other.
    layout = ml.Layout([[[2.0, 5.0], [8.0, 5.0]]], [[0.5, 0.5]], [[210.0, 230.0]])
    rut = variables.spread(variables.vector(layout))
    found = variables.layout_of(refocus(problem, variables, rut, in_order(variables))).focus.flatten().sort().values
    published = truths["defocus_only_equal_apertures"]["0.2-2.0"]["2"]["foci"]
    # One at a time they come within three steps of the values tried: a factor of 10^(1/63), 3.7 %, each.
    torch.testing.assert_close(found / 1000, torch.tensor(published).double(), rtol=3 * 0.037, atol=0)


@pytest.mark.parametrize("own", [False, True], ids=["closed form", "own cue"])
def test_the_score_never_gets_worse(crowded: ml.Problem, own: bool, generator: torch.Generator) -> None:
    problem = with_own_cue(crowded) if own else crowded
    variables, share = drawn(problem, generator)
    after = refocus(problem, variables, share, in_order(variables))
    before, now = (problem.score(variables.layout_of(each)) for each in (share, after))
    # In single precision two values may be as good as each other.
    assert (now <= before * (1 + 1e-5)).all()


@pytest.mark.parametrize("afresh", [False, True])
def test_only_foci_change(crowded: ml.Problem, afresh: bool, generator: torch.Generator) -> None:
    variables, share = drawn(crowded, generator)
    after = refocus(crowded, variables, share, in_order(variables), afresh)
    assert after[:, : variables.focus_start].equal(share[:, : variables.focus_start])
    assert not after.equal(share)


@pytest.mark.parametrize("own", [False, True], ids=["closed form", "own cue"])
def test_a_single_focus_is_the_best_of_all_values_tried(own: bool) -> None:
    lens = ml.Lens(5.0, (1.0, 1.0), (300.0, 2000.0))
    problem = ml.Problem(ml.Back.rectangle(9, 9), [lens], ml.log_depths(300, 2000, 37), cues=[ml.LensDefocus()])
    variables = Variables(with_own_cue(problem))
    share = torch.full((1, 4), 0.1, dtype=torch.float64).index_fill(1, torch.tensor([2]), 0.0)
    found = refocus(with_own_cue(problem) if own else problem, variables, share, in_order(variables))
    tried = share.repeat(VALUES, 1)
    tried[:, 3] = torch.linspace(0, 1, VALUES).double()
    best = problem.score_over_depths(variables.layout_of(tried)).argmin()
    assert found[0, 3].item() == pytest.approx(tried[best, 3].item(), abs=1e-6)


def test_both_ways_choose_alike(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables, share = drawn(crowded, generator, 12)
    closed = refocus(crowded, variables, share, in_order(variables))
    general = refocus(with_own_cue(crowded), variables, share, in_order(variables))
    # But for a tie that rounding decides; then both score alike.
    one, other = (crowded.score(variables.layout_of(each)) for each in (closed, general))
    assert (one / other - 1).abs().median().item() < 1e-6


def test_two_foci_are_nearly_as_good_as_the_best_of_all_pairs(generator: torch.Generator) -> None:
    lenses = [ml.Lens(5.0, (1.0, 1.0), position=(2.0, 2.0)), ml.Lens(5.0, (2.0, 2.0), position=(7.0, 7.0))]
    problem = ml.Problem(ml.Back.rectangle(9, 9), lenses, ml.log_depths(300, 2000, 64), cues=[ml.LensDefocus()])
    variables = Variables(problem)
    pairs = torch.tensor(list(product(torch.linspace(0, 1, VALUES).tolist(), repeat=2)), dtype=torch.float64)
    every = torch.zeros(len(pairs), 8, dtype=torch.float64)
    every[:, 6:] = pairs
    best = problem.score(variables.layout_of(every)).min()
    found = refocus(problem, variables, every[[0, 5, 999, -1]], in_order(variables))
    # One at a time, and two rounds: near it, from wherever they began.
    assert (problem.score(variables.layout_of(found)) < 1.25 * best).all()


def test_afresh_does_not_depend_on_the_foci_before(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables, share = drawn(crowded, generator)
    other = share.clone()
    other[:, variables.focus_start :] = torch.rand(6, 4, generator=generator, dtype=torch.float64)
    one, two = (refocus(crowded, variables, each, in_order(variables), afresh=True) for each in (share, other))
    assert one.equal(two)


def test_afresh_a_focus_that_is_fixed_counts_all_the_same() -> None:
    # The first lens is fixed where a single one is best: the second must not be told to go there too.
    depths = ml.linear_depths(300, 900, 64)
    best = ((depths**3).sum() / (depths**2).sum()).item()
    lens = ml.Lens(5.0, (1.0, 1.0), (300.0, 900.0), position=(3.0, 3.0))
    lenses = [replace(lens, focus=(best, best)), replace(lens, position=(6.0, 6.0))]
    problem = ml.Problem(ml.Back.rectangle(9, 9), lenses, depths, cues=[ml.LensDefocus()])
    variables = Variables(problem)
    share = torch.zeros(1, 8, dtype=torch.float64)
    found = variables.layout_of(refocus(problem, variables, share, in_order(variables), afresh=True))
    assert abs(found.focus[0, 1, 0].item() - best) > 50


def test_what_is_fixed_stays() -> None:
    lens = ml.Lens(5.0, (1.0, 1.0), (400.0, 400.0))
    problem = ml.Problem(ml.Back.rectangle(9, 9), [lens] * 2, ml.log_depths(300, 2000, 8))
    variables = Variables(problem)
    share = torch.full((2, len(variables.low)), 0.25, dtype=torch.float64)
    assert refocus(problem, variables, share, in_order(variables), afresh=True).equal(share)


def test_with_stereo_alone_foci_stay(crowded: ml.Problem, generator: torch.Generator) -> None:
    problem = ml.Problem(crowded.back, crowded.lenses, crowded.depths, cues=[ml.PairStereo()], gap=crowded.gap)
    variables, share = drawn(problem, generator)
    assert refocus(problem, variables, share, in_order(variables)).equal(share)


def test_a_layout_is_refocused_the_same_alone_and_in_a_batch(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables, share = drawn(crowded, generator, 20)
    together = refocus(crowded, variables, share, in_order(variables))
    alone = torch.cat([refocus(crowded, variables, each[None], in_order(variables)) for each in share])
    one, other = (crowded.score(variables.layout_of(each)) for each in (together, alone))
    torch.testing.assert_close(one, other, rtol=1e-5, atol=0)
