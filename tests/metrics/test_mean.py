"""Means over the depths against closed forms of a single pair, and what the search and the bound make of them."""

import pytest
import torch

import multilens as ml
from multilens.bounds.bound import lower_bound
from multilens.metrics import as_quoted

LENS = ml.Lens(5.0, (1.0, 1.0), disparity_noise=1e-3, blur_noise=1e-3)
BACK = ml.Back.rectangle(30, 40)
PAIR = ml.Layout([[0.0, 0.0], [0.0, 20.0]], [1.0, 1.0], [500.0, 500.0])
GAIN = 1e-3 / (20 * 5)
"""1/mm; the pair's error is this times Z^2."""


def stereo(metric: ml.MeanSquare | ml.Relative | ml.InverseDepth) -> ml.Problem:
    # By the trapezoidal rule a mean over the depths is one over the range.
    weights = torch.ones(4001, dtype=torch.float64)
    weights[0] = weights[-1] = 0.5
    return ml.Problem(BACK, [LENS] * 2, ml.linear_depths(200, 2000, 4001), weights, [ml.PairStereo()], metric=metric)


@pytest.mark.parametrize(
    ("metric", "mean_power", "figure", "unit"),
    [(ml.MeanSquare(), 4, 1.0, "mm"), (ml.Relative(), 2, 100.0, "%"), (ml.InverseDepth(), 0, 1000.0, "1/m")],
)
def test_a_pair_has_its_closed_form(metric, mean_power, figure, unit):
    # err / Z^k is gain Z^(2 - k): the mean of its square over the range is that of a power of Z.
    power = mean_power + 1
    mean = (2000.0**power - 200.0**power) / (power * 1800)
    problem = stereo(metric)
    assert metric.figure(problem.score(PAIR).item()) == pytest.approx(figure * GAIN * mean**0.5, rel=1e-6)
    assert metric.unit == unit


@pytest.mark.parametrize(
    ("metric", "power", "factor"),
    [(ml.MeanSquare(), 2, 1.0), (ml.Relative(), 1, 100.0), (ml.InverseDepth(), 0, 1000.0)],
)
def test_the_error_of_a_pair_is_quoted_in_the_unit_of_the_metric(metric, power, factor):
    depths = ml.linear_depths(200, 2000, 7)
    quoted = as_quoted(metric, GAIN * depths**2, depths)
    torch.testing.assert_close(quoted, factor * GAIN * depths**power)


def test_what_nothing_measures_stays_infinite_where_a_metric_does_not_count_it():
    class Near(ml.MeanSquare):
        def factor(self, depths):
            return (depths < 1000).to(depths)

    depths = torch.tensor([500.0, 1500.0, 1600.0], dtype=torch.float64)
    errors = torch.tensor([2.0, 3.0, torch.inf], dtype=torch.float64)
    assert as_quoted(Near(), errors, depths).tolist() == [2.0, 0.0, torch.inf]


@pytest.mark.parametrize("metric", [ml.Relative(), ml.InverseDepth()])
def test_a_single_focus_is_where_the_weighted_slope_vanishes(metric):
    # Zf = sum v Z^3 / sum v Z^2 with v = 1 / Z^2 or 1 / Z^4 over the range.
    near, far = 200.0, 2000.0
    expected = {
        "relative RMSE": (far**2 - near**2) / 2 / (far - near),
        "RMSE of 1/Z": torch.tensor(far / near).log().item() / (1 / near - 1 / far),
    }[metric.name]
    lens = ml.Lens(5.0, (1.0, 1.0), position=(5.0, 5.0))
    depths = ml.linear_depths(near, far, 4001)
    problem = ml.Problem(BACK, [lens], depths, cues=[ml.LensDefocus()], metric=metric)
    design = ml.solve(problem, starts=2, patience=0, proof=0)
    assert design.layout.focus.item() == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("metric", [ml.Relative(), ml.InverseDepth()])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_bound_holds_and_is_near(metric, count):
    lens = ml.Lens(5.0, (0.5, 2.0), disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(BACK, [lens] * count, ml.log_depths(200, 2000, 96), metric=metric)
    design = ml.solve(problem, starts=12, patience=0, proof=200)
    assert design.bound is not None
    assert design.bound.value is not None
    assert design.bound.value <= design.score * (1 + 1e-9)
    assert design.gap < 0.05


@pytest.mark.parametrize("metric", [ml.Relative(), ml.InverseDepth()])
def test_the_closed_form_agrees_with_the_sum_over_depths(metric):
    problem = ml.Problem(BACK, [LENS] * 3, ml.log_depths(200, 2000, 64), metric=metric)
    random = torch.Generator().manual_seed(0)
    share = torch.rand(8, 3, 4, dtype=torch.float64, generator=random)
    layout = ml.Layout(30 * share[..., :2], 0.5 + share[..., 2], 200 * 10 ** share[..., 3:])
    torch.testing.assert_close(problem.score(layout), problem.score_over_depths(layout), rtol=1e-9, atol=0)


def test_weights_of_a_metric_are_no_more_than_weights():
    # The same problem, asked by weights in place of a metric, has the same bound up to the factor of the weights' sum.
    depths = ml.log_depths(200, 2000, 64)
    by_metric = ml.Problem(BACK, [LENS] * 2, depths, metric=ml.Relative())
    by_weights = ml.Problem(BACK, [LENS] * 2, depths, depths**-2)
    scale = (depths**-2).mean().item()
    bounds = [lower_bound(problem, 50).value for problem in (by_metric, by_weights)]
    assert bounds[0] == pytest.approx(bounds[1] * scale, rel=1e-9)


def test_the_rmse_is_in_millimetres_whichever_metric_is_asked_for():
    asked = ml.Problem(BACK, [LENS] * 2, ml.log_depths(200, 2000, 64), metric=ml.InverseDepth())
    plain = ml.Problem(BACK, [LENS] * 2, ml.log_depths(200, 2000, 64))
    torch.testing.assert_close(asked.mean_square(PAIR), plain.score(PAIR), rtol=1e-9, atol=0)
