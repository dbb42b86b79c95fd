from dataclasses import replace

import pytest
import torch
from torch import Tensor

import multilens as ml
from multilens.search.foci import Foci
from multilens.search.variables import Variables


class Own:
    """Defocus as a cue of one's own: nothing in closed form is known of it."""

    def measurements(self, lenses):
        return ml.LensDefocus().measurements(lenses)

    def __call__(self, layout, lenses, depths):
        return ml.LensDefocus()(layout, lenses, depths)


def foci_of(problem: ml.Problem | ml.ScoreProblem, seed: int = 0) -> tuple[Variables, Foci, Tensor]:
    variables = Variables(problem)
    random = torch.Generator().manual_seed(seed)
    x = torch.rand(9, len(variables), generator=random, dtype=torch.float64) * variables.upper
    return variables, Foci(problem, variables, random), variables.spread(x)


def with_cues(problem: ml.Problem, *cues) -> ml.Problem:
    return ml.Problem(problem.back, problem.lenses, problem.depths, problem.weights, cues, problem.gap)


@pytest.fixture(params=["closed form", "own cue", "stereo alone"])
def asked(request: pytest.FixtureRequest, crowded: ml.Problem) -> ml.Problem:
    cues = {"closed form": crowded.cues, "own cue": (ml.PairStereo(), Own()), "stereo alone": (ml.PairStereo(),)}
    return with_cues(crowded, *cues[request.param])


@pytest.mark.parametrize("way", [Foci.afresh, Foci.improved])
def test_only_foci_change(asked: ml.Problem, way) -> None:
    variables, foci, share = foci_of(asked)
    after = way(foci, share.clone())
    assert after[:, : variables.focus_start].equal(share[:, : variables.focus_start])


@pytest.mark.parametrize("way", [Foci.afresh, Foci.improved])
def test_foci_stay_within_their_bounds(asked: ml.Problem, way) -> None:
    variables, foci, share = foci_of(asked)
    after = way(foci, share)[:, variables.focus_start :]
    assert ((after >= 0) & (after <= 1)).all()


def test_afresh_does_not_depend_on_the_foci_before(crowded: ml.Problem) -> None:
    variables, foci, share = foci_of(crowded)
    other = share.clone()
    other[:, variables.focus_start :] = 0.5
    again = Foci(crowded, variables, torch.Generator().manual_seed(1))
    foci.generator = torch.Generator().manual_seed(1)
    assert foci.afresh(share).equal(again.afresh(other))


def test_the_best_is_never_worse_than_it_was(asked: ml.Problem) -> None:
    variables, foci, share = foci_of(asked)
    for each in share:
        before, after = (asked.score(variables.layout_of(one)) for one in (each, foci.best_for(each)))
        assert after <= before


def test_of_equal_lenses_the_best_has_the_best_foci() -> None:
    # Weighted k-means in one dimension: for a single lens of three tiers, the published foci of three equal apertures.
    lens = ml.Lens(1000.0, (0.5, 0.5), position=(5.0, 5.0), tiers=3)
    problem = ml.Problem(ml.Back.rectangle(9, 9), [lens], ml.linear_depths(200, 2000, 601), cues=[ml.LensDefocus()])
    variables, foci, share = foci_of(problem)
    found = variables.layout_of(foci.best_for(share[0])).focus.flatten().sort().values / 1000
    published = torch.tensor([0.8366119, 1.38364663, 1.81432595], dtype=torch.float64)
    torch.testing.assert_close(found, published, rtol=0, atol=0.02)


def test_what_is_fixed_stays(crowded: ml.Problem) -> None:
    lenses = [replace(crowded.lenses[0], focus=(700.0, 700.0)), *crowded.lenses[1:]]
    problem = ml.Problem(crowded.back, lenses, crowded.depths, gap=crowded.gap)
    variables, foci, share = foci_of(problem)
    for after in (foci.afresh(share), foci.improved(share), foci.best_for(share[0]).unsqueeze(0)):
        assert (variables.layout_of(after).focus[:, 0] == 700).all()


def test_where_every_focus_is_fixed_nothing_changes() -> None:
    lens = ml.Lens(5.0, (0.5, 1.0), (400.0, 400.0))
    problem = ml.Problem(ml.Back.rectangle(9, 9), [lens] * 2, ml.log_depths(300, 2000, 8))
    _, foci, share = foci_of(problem)
    assert foci.afresh(share).equal(share)
    assert foci.best_for(share[0]).equal(share[0])


def test_the_same_generator_gives_the_same(crowded: ml.Problem) -> None:
    one, other = (foci_of(crowded, seed=3) for _ in range(2))
    assert one[1].afresh(one[2]).equal(other[1].afresh(other[2]))
    assert one[1].improved(one[2]).equal(other[1].improved(other[2]))


def test_a_layout_alone_has_foci_too(crowded: ml.Problem) -> None:
    _, foci, share = foci_of(crowded)
    assert foci.afresh(share[:1]).shape == foci.improved(share[:1]).shape == share[:1].shape


def test_rearranged_lenses_are_never_worse(asked: ml.Problem) -> None:
    variables, foci, share = foci_of(asked)
    for each in share:
        before, after = (asked.score(variables.layout_of(one)) for one in (each, foci.rearranged(each)))
        assert after <= before


def test_many_unlike_lenses_are_better_rearranged_than_dealt() -> None:
    # Twelve apertures of their own are too many to be told apart when they are dealt.
    lenses = [ml.Lens(1.0, (width, width)) for width in torch.linspace(3, 8, 12).tolist()]
    problem = ml.Problem(ml.Back.rectangle(60, 60), lenses, ml.linear_depths(20, 50, 256))
    variables, foci, share = foci_of(problem)
    dealt, rearranged = (problem.score(variables.layout_of(way(share[0]))) for way in (foci.dealt, foci.rearranged))
    assert rearranged < dealt
