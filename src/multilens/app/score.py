"""From what a configuration says of the score to metric, fusion and weights. Checking needs no torch, building does."""

from itertools import pairwise
from math import isfinite
from typing import TYPE_CHECKING

from multilens.app.refusal import RefusedError, refused_at
from multilens.app.schema import DepthConfig
from multilens.app.schema_score import FusionConfig, MetricConfig, MetricName

if TYPE_CHECKING:
    from torch import Tensor

    from multilens.fusion import Fusion
    from multilens.metrics import Metric

WORST = MetricName["worst_case"]
MOST_BINS = 4096


def check_score(metric: MetricConfig, fusion: FusionConfig, depth: DepthConfig) -> None:
    """Check what goes together and the ranges, without torch.

    Raises:
        RefusedError: something is out of its range or does not go together.
    """
    if metric.of is not None and metric.name is not WORST:
        raise RefusedError(
            f"metric.of must be null beside all but metric.name=worst_case, got {metric.of.name} beside {metric.name.name}"
        )
    if fusion.guess is not None and not (isfinite(fusion.guess) and fusion.guess > 0):
        raise RefusedError(f"fusion.guess must be > 0 mm and finite, or null, got {fusion.guess:g}")
    if depth.histogram.edges or depth.histogram.shares:
        _check_histogram(depth)


def build_metric(config: MetricConfig) -> "Metric":
    """Make the metric."""
    from multilens.metrics import METRICS, WorstCase

    if config.name is WORST:
        return WorstCase(METRICS[config.of.name]()) if config.of else WorstCase()
    return METRICS[config.name.name]()


def build_fusion(config: FusionConfig) -> "Fusion":
    """Make the fusion."""
    from multilens.fusion import FUSIONS

    return FUSIONS[config.name.name]()


def build_depths(config: DepthConfig) -> "tuple[Tensor, Tensor | None]":
    """Make the depths, mm, and their weights; None where all count alike.

    Raises:
        RefusedError: something is out of its range, or a bin of the histogram has no depth.
    """
    from multilens.depths import histogram_weights, linear_depths, log_depths

    spread = {"linear": linear_depths, "log": log_depths}[config.spacing.name]
    with refused_at("depth"):
        depths = spread(config.near, config.far, config.count)
    if not config.histogram.shares:
        return depths, None
    with refused_at("depth.histogram"):
        return depths, histogram_weights(depths, config.histogram.edges, config.histogram.shares)


def _check_histogram(depth: DepthConfig) -> None:
    edges, shares = depth.histogram.edges, depth.histogram.shares
    if not 1 <= len(shares) <= MOST_BINS or len(edges) != len(shares) + 1:
        raise RefusedError(
            f"depth.histogram must have from 1 to {MOST_BINS} shares and one edge more, got {len(shares)} and {len(edges)}"
        )
    if not all(first < last for first, last in pairwise(edges)) or (edges[0], edges[-1]) != (depth.near, depth.far):
        raise RefusedError(
            f"depth.histogram.edges must ascend from depth.near = {depth.near:g} to depth.far = {depth.far:g} mm, "
            f"got {', '.join(f'{edge:g}' for edge in edges[:8])}"
        )
    if not all(isfinite(share) and share >= 0 for share in shares) or not sum(shares) > 0:
        raise RefusedError("depth.histogram.shares must be >= 0 and finite, not all 0")
