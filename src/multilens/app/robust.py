"""From what a configuration says of devices that are not as drawn to the question of them. Only `build_robust` needs torch."""

from math import isfinite
from typing import TYPE_CHECKING

from multilens.app.refusal import RefusedError, refused_at
from multilens.app.schema import RobustConfig

if TYPE_CHECKING:
    from multilens.problem import Problem
    from multilens.question import Question

MOST_DEVICES = 4096


def check_robust(config: RobustConfig) -> None:
    """Check the ranges, without torch.

    Raises:
        RefusedError: a number is out of its range.
    """
    drift = config.drift
    lengths = {
        "shift": (config.shift, "mm"),
        "focus_dioptre": (config.focus_dioptre, "dioptres"),
        "drift.shift": (drift.shift, "mm"),
        "drift.decentre_um": (drift.decentre_um, "um"),
        "drift.focus_dioptre": (drift.focus_dioptre, "dioptres"),
    }
    for key, (value, unit) in lengths.items():
        if not (isfinite(value) and value >= 0):
            raise RefusedError(f"robust.{key} must be >= 0 {unit} and finite, got {value:g}")
    for key, value in (("covered", config.covered), ("level", config.level)):
        if not 0 <= value <= 1:
            raise RefusedError(f"robust.{key} must be from 0 to 1, got {value:g}")
    if not 2 <= config.samples <= MOST_DEVICES or config.samples % 2:
        raise RefusedError(f"robust.samples must be an even number from 2 to {MOST_DEVICES}, got {config.samples}")
    if not 0 <= config.seed < 2**31:
        raise RefusedError(f"robust.seed must be from 0 to {2**31 - 1}, got {config.seed}")


def build_robust(config: RobustConfig, problem: "Problem") -> "Question":
    """Ask a problem of many devices; where nothing sets them apart, of one."""
    from multilens.cues.drift import Drift
    from multilens.disturbance import Disturbance
    from multilens.robust import Robust

    drift = Drift(config.drift.shift, config.drift.decentre_um, config.drift.focus_dioptre)
    disturbance = Disturbance(config.shift, config.focus_dioptre, config.covered, drift)
    if disturbance == Disturbance():
        return problem
    with refused_at("robust"):
        return Robust(problem, disturbance, config.level, config.samples, config.seed)
