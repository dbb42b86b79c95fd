"""Metrics: which error of all depths counts, and the number that people quote."""

from multilens.metrics.mean import InverseDepth, MeanSquare, Relative
from multilens.metrics.metric import Metric, as_quoted, in_words
from multilens.metrics.worst_case import WorstCase

__all__ = ["METRICS", "InverseDepth", "MeanSquare", "Metric", "Relative", "WorstCase", "as_quoted", "in_words"]

METRICS = {"mean_square": MeanSquare, "relative": Relative, "inverse_depth": InverseDepth, "worst_case": WorstCase}
"""Every metric that a file or a command line may name."""
