"""The layouts that the study compares, and what no number of lenses can do better."""

from dataclasses import dataclass
from math import hypot

import torch
from hydra import compose, initialize_config_dir
from jaxtyping import Float
from torch import Tensor

import multilens as ml
from multilens.app.build import build_problem, typed
from multilens.app.compose import config_folder
from multilens.app.schema import register
from multilens.metrics import Metric

SEED = 0
"""Fixed before the first search."""

PARALLAX = 0.738 / 6.86
"""Largest b / Z: the disparity limit over the focal length, which is nearer than what the overlap of the fields asks for."""

NOISE = 0.000244 / 6.86
"""Angular noise of a pair of main cameras, rad."""

BODY = 6.86 / (2 * 1.78) + 6.17
"""Radius of a lens' body, mm."""

FARTHEST = hypot(76.73 - 26, 159.86 - 26) + 2 * (13 - BODY)
"""Largest distance of two bodies on the back, a rounded rectangle of 76.73 x 159.86 mm with corners of 13 mm, mm."""

METRICS: dict[str, Metric] = {"mean_square": ml.MeanSquare(), "relative": ml.Relative()}


def asked(*overrides: str) -> ml.Problem:
    """Give the question of a configuration."""
    register()
    with initialize_config_dir(str(config_folder()), version_base="1.3"):
        problem = build_problem(typed(compose("config", list(overrides))))
    assert isinstance(problem, ml.Problem)
    return problem


@dataclass(frozen=True)
class Case:
    """One row of the table.

    Args:
        metric: which error counts, a word of METRICS.
        count: of the lenses.
        limited: whether pairs fail where they may not be used.
    """

    metric: str
    count: int
    limited: bool = True

    @property
    def name(self) -> str:
        """For files."""
        return f"{self.metric}_{self.count}"

    def problem(self) -> ml.Problem:
        """Give the question."""
        whole = asked("experiment=usable_pairs", f"lenses.count={self.count}")
        cues = whole.cues if self.limited else (ml.PairStereo(),)
        metric = METRICS[self.metric]
        return ml.Problem(whole.back, whole.lenses, whole.depths, whole.weights, cues, whole.gap, metric=metric)

    def design(self) -> ml.Design:
        """Give the best layout that the default search finds."""
        return ml.solve(self.problem(), seed=SEED, proof=0)


CASES = tuple(Case(metric, count) for metric in METRICS for count in (2, 3, 4, 5))


def floor_error(depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
    """Give the error below which no number of lenses comes at a depth, Z^2 delta / min(P Z, b_max), mm.

    As if at every depth some pair had the widest baseline that may be used there.
    """
    return depths**2 * NOISE / (PARALLAX * depths).clamp(max=FARTHEST)


def floor(metric: str, depths: Float[Tensor, " z"]) -> float:
    """Give the figure that the floor has in a metric."""
    kind = METRICS[metric]
    return kind.figure((floor_error(depths).square() * kind.factor(depths)).mean().item())


def unlike() -> ml.Problem:
    """Give the question of the three unlike cameras."""
    return asked("experiment=wide_ultrawide_tele")


def nearest(
    limits: ml.PairLimits, pair: tuple[ml.Lens, ml.Lens], baselines: Float[Tensor, " b"]
) -> Float[Tensor, " b"]:
    """Give the depth from which on a pair may be used, for every baseline between its lenses, mm."""
    along = torch.stack([torch.zeros_like(baselines), baselines], dim=-1)
    layout = ml.Layout(torch.stack([along, torch.zeros_like(along)], dim=-1), along, along.unsqueeze(-1))
    return limits.nearest(layout, pair).squeeze(-1)
