"""The worst of all depths against closed forms, the search and the bound."""

import pytest
import torch

import multilens as ml
from multilens.metrics import in_words

LENS = ml.Lens(5.0, (1.0, 1.0), disparity_noise=1e-3, blur_noise=1e-3)
BACK = ml.Back.rectangle(30, 40)
PAIR = ml.Layout([[0.0, 0.0], [0.0, 20.0]], [1.0, 1.0], [500.0, 500.0])
DEPTHS = ml.linear_depths(200, 2000, 181)


@pytest.mark.parametrize(("metric", "worst"), [(ml.WorstCase(), 40.0), (ml.WorstCase(ml.Relative()), 2.0)])
def test_stereo_is_worst_at_the_far_end(metric, worst):
    problem = ml.Problem(BACK, [LENS] * 2, DEPTHS, cues=[ml.PairStereo()], metric=metric)
    assert metric.figure(problem.score(PAIR).item()) == pytest.approx(worst)


def test_inverse_depth_is_as_bad_everywhere():
    problem = ml.Problem(BACK, [LENS] * 2, DEPTHS, cues=[ml.PairStereo()], metric=ml.WorstCase(ml.InverseDepth()))
    terms = problem.terms(PAIR)
    torch.testing.assert_close(terms, terms[:1].expand_as(terms), rtol=1e-12, atol=0)


def test_a_depth_without_weight_does_not_count():
    weights = (DEPTHS <= 1000).double()
    problem = ml.Problem(BACK, [LENS] * 2, DEPTHS, weights, [ml.PairStereo()], metric=ml.WorstCase())
    assert problem.score(PAIR).item() == pytest.approx(10.0**2)


def test_its_name_and_unit_are_those_of_its_error():
    assert in_words(ml.WorstCase(), 4.0) == "worst error 2 mm"
    assert in_words(ml.WorstCase(ml.Relative()), 1e-4) == "worst relative error 1 %"
    assert in_words(ml.WorstCase(ml.InverseDepth()), 4.0) == "worst error of 1/Z 2 1/m"
    assert in_words(None, 4.0) == "score 4"


@pytest.mark.parametrize("of", [ml.MeanSquare(), ml.Relative()])
def test_a_search_comes_near_its_bound(of):
    lens = ml.Lens(5.0, (0.5, 2.0), disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(BACK, [lens] * 3, ml.log_depths(200, 2000, 128), metric=ml.WorstCase(of))
    design = ml.solve(problem, starts=16, patience=1, proof=100)
    assert design.bound is not None
    assert design.bound.value is not None
    assert design.bound.value <= design.score * (1 + 1e-9)
    assert design.gap < 0.3


def test_what_is_saved_is_read_back(tmp_path):
    problem = ml.Problem(BACK, [LENS] * 2, DEPTHS, metric=ml.WorstCase(ml.Relative()), fusion=ml.InverseVariance())
    design = ml.solve(problem, starts=4, patience=0)
    design.save(tmp_path / "design.json")
    again = ml.Design.load(tmp_path / "design.json")
    assert (again.figure, again.problem.metric, again.problem.fusion) == (design.figure, problem.metric, problem.fusion)
    assert "worst relative error" in str(again)
