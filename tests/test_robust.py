"""A question asked of many devices, against closed forms, brute force and other devices."""

from dataclasses import replace
from typing import Any

import pytest
import torch
from torch import Tensor
from torch.autograd import gradcheck

from multilens import Back, Layout, Lens, LensDefocus, PairStereo, Problem, log_depths, solve
from multilens.cues import LimitedStereo, PairLimits, PhotometricDefocus, PhotometricStereo
from multilens.cues.drift import Drift
from multilens.disturbance import Disturbance
from multilens.fusion import InverseVariance
from multilens.metrics import Relative, WorstCase
from multilens.question import Question
from multilens.robust import Robust, as_drawn, without
from multilens.scene import Scene
from multilens.sensor import Sensor

LENS = Lens(6.0, (0.5, 2.0), clearance=3.0, disparity_noise=0.0002, blur_noise=0.0002)
CAMERA = replace(LENS, sensor=Sensor(1.2, 6000.0, 2.0, 0.3))
SCENE = Scene(0.3, 20.0, 500.0, 10.0, 200)
DEPTHS = log_depths(300, 2000, 32)
PROBLEM = Problem(Back.rectangle(40, 30), [LENS] * 3, DEPTHS)
LAYOUT = Layout([[6.0, 6.0], [33.0, 7.0], [8.0, 23.0]], [2.0, 1.9, 1.8], [600.0, 1100.0, 1700.0])
ALL = Disturbance(shift=0.1, focus_dioptre=0.02, covered=0.3, drift=Drift(0.01, 0.1, 0.01))


def test_devices_that_are_as_drawn_score_as_the_problem_does():
    for level in (0.0, 0.5, 1.0):
        assert Robust(PROBLEM, Disturbance(), level).score(LAYOUT).item() == PROBLEM.score(LAYOUT).item()


def test_a_shift_of_a_pair_costs_by_the_mean_of_one_over_its_baseline_squared():
    pair = Problem(Back.rectangle(40, 30), [LENS] * 2, DEPTHS, cues=[PairStereo()])
    layout = Layout([[5.0, 5.0], [15.0, 5.0]], [1.0, 1.0], [500.0, 500.0])
    score = Robust(pair, Disturbance(shift=0.2), samples=1024).score(layout).item()
    # b^2 is (10 + u)^2 + v^2 with u and v of variance 2 sigma^2 = 0.08: E[1/b^2] = 1/100 (1 + (3 - 1) 0.08 / 100 + ...).
    assert score / pair.score(layout).item() == pytest.approx(1 + 2 * 0.08 / 100, abs=5e-5)


def test_a_covered_lens_leaves_the_problem_of_the_others():
    outcomes = []
    for kept in ([1, 2], [0, 2], [0, 1]):
        left = Problem(PROBLEM.back, [LENS] * 2, DEPTHS)
        outcomes.append(
            left.score(Layout(LAYOUT.position[kept], LAYOUT.aperture_radius[kept], LAYOUT.focus[kept])).item()
        )
    nominal = PROBLEM.score(LAYOUT).item()
    sometimes = Disturbance(covered=0.3)
    mean = 0.7 * nominal + 0.1 * sum(outcomes)
    assert Robust(PROBLEM, sometimes).score(LAYOUT).item() == pytest.approx(mean, rel=1e-12)
    assert Robust(PROBLEM, sometimes, level=1).score(LAYOUT).item() == pytest.approx(max(outcomes), rel=1e-12)
    # The worst tenth is the worst lens covered.
    assert Robust(PROBLEM, sometimes, level=0.9).score(LAYOUT).item() == pytest.approx(max(outcomes), rel=1e-12)


@pytest.mark.parametrize("level", [0.0, 0.9])
def test_the_samples_stand_for_all_devices(level: float):
    question = Robust(PROBLEM, Disturbance(0.1, 0.02), level, samples=64)
    plain = torch.randn(20_000, 3, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(1))
    built = Layout(
        LAYOUT.position + 0.1 * plain[..., :2],
        LAYOUT.aperture_radius.expand(20_000, 3),
        1 / (1 / LAYOUT.focus + 2e-5 * plain[..., 2:]),
    )
    scores = PROBLEM.score(built).sort().values
    expected = scores[int(level * len(scores)) :].mean().item()
    # A sample of 64 tells the mean to some per cent, and a tail of six of them to a few more.
    assert question.score(LAYOUT).item() == pytest.approx(expected, rel=0.1)
    assert question.afresh(3, 4096).score(LAYOUT).item() == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("level", [0.0, 0.8, 1.0])
def test_what_is_minimised_is_what_is_claimed(level: float):
    question = Robust(PROBLEM, ALL, level, samples=4)
    assert question.terms(LAYOUT).max().item() == pytest.approx(question.score(LAYOUT).item(), rel=1e-12)


@pytest.mark.parametrize(
    "problem",
    [
        Problem(PROBLEM.back, [LENS] * 3, DEPTHS, metric=Relative(), fusion=InverseVariance()),
        Problem(PROBLEM.back, [LENS] * 3, DEPTHS, metric=WorstCase()),
        Problem(PROBLEM.back, [LENS] * 3, DEPTHS, cues=[LimitedStereo(PairLimits(0.4)), LensDefocus()]),
        Problem(PROBLEM.back, [CAMERA] * 3, DEPTHS, cues=[PhotometricStereo(SCENE), PhotometricDefocus(SCENE, 0.06)]),
    ],
    ids=["relative, fused", "worst case", "limited", "photometric"],
)
def test_every_metric_fusion_and_cue_is_claimed_exactly_and_never_below_what_is_minimised(problem: Problem):
    question = Robust(problem, ALL, 0.5, samples=4)
    assert question.score(LAYOUT).isfinite()
    assert question.terms(LAYOUT).max() >= question.score(LAYOUT) * (1 - 1e-12)
    assert question.metric.unit == problem.metric.unit


@pytest.mark.parametrize("level", [0.0, 0.8, 1.0])
def test_gradients(level: float):
    question = Robust(PROBLEM, ALL, level, samples=4)

    def terms(position: Tensor, radius: Tensor, focus: Tensor) -> Tensor:
        return question.terms(Layout(position, radius, focus))

    parts = (LAYOUT.position, LAYOUT.aperture_radius, LAYOUT.focus)
    # At depths that are sampled a winner may change within the step of the check: it is small.
    assert gradcheck(terms, [part.clone().requires_grad_() for part in parts], eps=1e-7, rtol=1e-3)


def test_a_batch_scores_as_its_layouts_do_one_by_one():
    question = Robust(PROBLEM, ALL, 0.5, samples=4)
    batch = Layout(*(torch.stack([part, part * 1.01]) for part in vars(LAYOUT).values()))
    together = question.score(batch)
    alone = torch.stack([question.score(batch[0]), question.score(batch[1])])
    torch.testing.assert_close(together, alone, rtol=1e-12, atol=0)


def test_it_is_a_question_and_keeps_the_constraints_of_its_problem():
    question = Robust(PROBLEM, ALL)
    assert isinstance(question, Question)
    assert (question.back, question.lenses, question.gap, question.focus_range) == (
        PROBLEM.back,
        PROBLEM.lenses,
        PROBLEM.gap,
        PROBLEM.focus_range,
    )


def test_as_drawn_is_the_device_itself_with_what_drifts():
    plain = Robust(PROBLEM, Disturbance(shift=0.1, covered=0.5))
    assert as_drawn(plain).score(LAYOUT).item() == PROBLEM.score(LAYOUT).item()
    assert as_drawn(Robust(PROBLEM, ALL)).score(LAYOUT) > PROBLEM.score(LAYOUT)
    assert as_drawn(PROBLEM) is PROBLEM


@pytest.mark.parametrize(("level", "name"), [(0, "RMSE over devices"), (1, "RMSE of the worst device")])
def test_the_figure_says_whose_it_is(level: float, name: str):
    assert Robust(PROBLEM, ALL, level).metric.name == name


def test_a_design_against_the_finger_lives_with_it_better_than_one_that_does_not_know_of_it():
    covered = Robust(PROBLEM, Disturbance(covered=1.0), level=1.0)
    nominal = solve(PROBLEM, starts=8, patience=0, proof=0)
    robust = solve(covered, starts=8, patience=0, proof=0)
    assert robust.certificate.feasible
    assert robust.score == covered.score(robust.layout).item()
    assert covered.score(robust.layout) < 0.95 * covered.score(nominal.layout)


def test_a_design_for_its_devices_is_better_on_others_too():
    question = Robust(PROBLEM, Disturbance(focus_dioptre=0.05), samples=16)
    nominal = solve(PROBLEM, starts=8, patience=0, proof=0)
    robust = solve(question, starts=8, patience=0, proof=0)
    others = question.afresh(1, 1024)
    assert others.score(robust.layout) < others.score(nominal.layout)
    # What was searched on these devices suits these better: other devices tell the truth.
    assert question.score(robust.layout) < others.score(robust.layout)


def test_nothing_measures_without_the_lens():
    alone = Problem(Back.disc(10), [LENS], DEPTHS, cues=[LensDefocus()])
    with pytest.raises(ValueError, match="lens 1 cannot be covered: without it nothing measures"):
        without(alone, 0)
    pair = Problem(Back.disc(10), [LENS] * 2, DEPTHS, cues=[PairStereo()])
    with pytest.raises(ValueError, match="lens 1 cannot be covered"):
        Robust(pair, Disturbance(covered=0.1))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"level": 1.5}, "level must be from 0 to 1, got 1.5"),
        ({"samples": 3}, "samples must be an even number >= 2, got 3"),
    ],
)
def test_numbers_out_of_range_are_refused(given: dict[str, Any], message: str):
    with pytest.raises(ValueError, match=message):
        Robust(PROBLEM, ALL, **given)
