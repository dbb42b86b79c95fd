"""Metric, fusion and histogram from a configuration, and what is refused of them."""

from argparse import Namespace

import pytest
import torch
from hydra import compose

import multilens as ml
from multilens.app import build
from multilens.app.compose import open_hydra
from multilens.app.refusal import RefusedError
from multilens.app.schema import DepthConfig
from multilens.app.schema_score import ErrorName, FusionConfig, FusionName, HistogramConfig, MetricConfig, MetricName
from multilens.app.score import build_depths, build_fusion, build_metric, check_score

MEAN, WORST, RELATIVE = (MetricName[word] for word in ("mean_square", "worst_case", "relative"))
PLAIN = DepthConfig(near=100, far=400, count=7)


def depth(edges: list[float], shares: list[float]) -> DepthConfig:
    return DepthConfig(near=100, far=400, count=7, histogram=HistogramConfig(edges, shares))


def test_words_become_metrics():
    assert build_metric(MetricConfig(RELATIVE)) == ml.Relative()
    assert build_metric(MetricConfig(WORST)) == ml.WorstCase()
    assert build_metric(MetricConfig(WORST, ErrorName["relative"])) == ml.WorstCase(ml.Relative())


def test_a_word_becomes_a_fusion():
    assert build_fusion(FusionConfig(FusionName["inverse_variance"])) == ml.InverseVariance()


def test_a_histogram_becomes_weights():
    depths, weights = build_depths(depth([100, 200, 400], [3, 1]))
    assert weights is not None
    assert weights[depths < 200].sum().item() == pytest.approx(0.75)


def test_without_a_histogram_all_depths_count_alike():
    assert build_depths(PLAIN)[1] is None


def test_a_bin_without_a_depth_is_refused():
    with pytest.raises(RefusedError, match=r"depth\.histogram: every bin"):
        build_depths(depth([100, 101, 102, 400], [1, 1, 1]))


def test_a_histogram_may_be_given_on_the_command_line():
    with open_hydra(Namespace(config_path=None, config_dir=None)):
        config = build.typed(compose("config", ["depth.histogram={edges: [200, 500, 5000], shares: [4, 1]}"]))
    problem = build.build_problem(config)
    assert problem.weights[problem.depths < 500].sum().item() == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("metric", "fusion", "asked", "words"),
    [
        (MetricConfig(MEAN, ErrorName["relative"]), FusionConfig(FusionName.best), PLAIN, "metric.of"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best, 0.0), PLAIN, "fusion.guess must be > 0 mm"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best, torch.inf), PLAIN, "fusion.guess"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best), depth([100, 400], [1, 1]), "one edge more"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best), depth([100, 300], [1]), "ascend from depth.near = 100"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best), depth([100, 90, 400], [1, 1]), "ascend"),
        (MetricConfig(MEAN), FusionConfig(FusionName.best), depth([100, 200, 400], [0, 0]), "not all 0"),
    ],
)
def test_what_does_not_hold_is_refused(metric, fusion, asked, words):
    with pytest.raises(RefusedError, match=words):
        check_score(metric, fusion, asked)
