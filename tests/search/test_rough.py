"""Questions at few depths: the same score up to the fineness of the depths, by the same lenses within the same bounds."""

from dataclasses import replace

import pytest
import torch

from multilens import Back, Layout, Lens, LensDefocus, Problem, linear_depths, log_depths
from multilens.cues.limited import LimitedStereo
from multilens.cues.limits import PairLimits
from multilens.disturbance import Disturbance
from multilens.metrics import WorstCase
from multilens.robust import Robust
from multilens.search.rough import FEW, FEW_DEVICES, at_few_depths

EYE = Lens(6.0, (0.5, 3.0), disparity_noise=1e-3, blur_noise=1e-3)
TWO = Layout([[10.0, 10.0], [60.0, 10.0]], [2.0, 1.0], [400.0, 900.0])
CUES = (LimitedStereo(PairLimits(max_disparity=0.5)), LensDefocus())


def asked(depths: torch.Tensor) -> Problem:
    return Problem(Back.rectangle(70, 20), [EYE] * 2, depths, cues=CUES)


def test_the_score_is_the_same_but_for_the_fineness_of_the_depths() -> None:
    fine = asked(log_depths(200, 5000, 512))
    assert at_few_depths(fine).score(TWO).item() == pytest.approx(fine.score(TWO).item(), rel=0.02)


def test_few_depths_reach_as_far_and_weigh_as_much() -> None:
    fine = asked(linear_depths(200, 5000, 301).flip(0))
    few = at_few_depths(fine)
    assert (len(few.depths), few.depths[0].item(), few.depths[-1].item()) == (FEW, 200.0, 5000.0)
    assert few.weights.sum().item() == pytest.approx(1, abs=1e-12)
    assert few.focus_range == fine.focus_range
    assert few.prior_error == fine.prior_error


def test_a_weight_stays_near_its_depth() -> None:
    weights = torch.zeros(256)
    weights[100] = 1
    fine = Problem(Back.rectangle(70, 20), [EYE] * 2, linear_depths(200, 2750, 256), weights, CUES)
    few = at_few_depths(fine)
    assert few.weights.count_nonzero() == 1
    assert few.depths[few.weights.argmax()].item() == pytest.approx(1200, abs=2550 / (FEW - 1) / 2 + 10)


def test_of_a_question_asked_of_many_devices_each_is_asked_at_few_depths() -> None:
    robust = Robust(asked(log_depths(200, 5000, 512)), Disturbance(shift=0.05), samples=4, seed=3)
    few = at_few_depths(robust)
    assert isinstance(few, Robust)
    assert len(few.problem.depths) == FEW
    assert few.score(TWO).item() == pytest.approx(robust.score(TWO).item(), rel=0.02)


def test_the_worst_case_of_the_thesis_cues_is_asked_at_every_depth() -> None:
    worst = Problem(Back.rectangle(70, 20), [EYE] * 2, log_depths(200, 5000, 512), metric=WorstCase())
    assert at_few_depths(worst) is worst


def test_of_many_devices_few_are_asked_where_each_costs_time() -> None:
    robust = Robust(asked(log_depths(200, 5000, 96)), Disturbance(shift=0.05), samples=64)
    few = at_few_depths(robust)
    assert isinstance(few, Robust)
    assert few.samples == FEW_DEVICES
    thesis = replace(robust, problem=Problem(Back.disc(9), [EYE] * 2, [200.0] * 300))
    assert at_few_depths(thesis) is thesis


@pytest.mark.parametrize("problem", [asked(log_depths(200, 5000, FEW)), Problem(Back.disc(9), [EYE], [200.0] * 300)])
def test_few_depths_and_a_closed_form_stay_as_they_are(problem: Problem) -> None:
    assert at_few_depths(problem) is problem
