"""The designs of the study: the same four cameras on the same back, each asked for another error."""

import multilens as ml

NOISE = 0.2 * 0.00122
LENS = ml.Lens.from_f_number(
    6.86, (1.78, 11.0), focus=(200, 5000), clearance=6.17, disparity_noise=NOISE, blur_noise=NOISE
)
METRICS = {
    "mean_square": ml.MeanSquare(),
    "relative": ml.Relative(),
    "inverse_depth": ml.InverseDepth(),
    "worst_case": ml.WorstCase(),
    "worst_relative": ml.WorstCase(ml.Relative()),
}
FUSIONS = {"best": ml.Best(), "inverse_variance": ml.InverseVariance()}
CASES = [(metric, "best") for metric in METRICS] + [("mean_square", "inverse_variance")]
"""Name of a metric, name of a fusion."""

SEED, DEPTHS = 0, 1024
"""1024 depths lie 0.3 % apart: a worst case between two of them is hardly worse."""


def problem(metric: str, fusion: str) -> ml.Problem:
    """Ask for one of the designs."""
    depths = ml.log_depths(200, 5000, DEPTHS)
    back = ml.Back.rectangle(70, 150)
    return ml.Problem(back, [LENS] * 4, depths, metric=METRICS[metric], fusion=FUSIONS[fusion])
