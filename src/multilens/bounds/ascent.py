"""The worth of the depths that gives the highest bound for given apertures and a given baseline.

The bound of a cut is concave in the worth. It starts from the dynamic programme for equal apertures and climbs by a gradient whose
largest saving is made smooth, with less and less smoothing. However good or bad the worth that comes out, its bound holds.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from multilens.bounds.contiguous import best_scores, stretch_costs, worth_of_depths
from multilens.bounds.cut import Depths, FocusGrid, focus_grid

STEPS = 60
SMOOTHING = (0.05, 0.002)
"""Width of the soft maximum over foci at the first and the last step, in parts of what a focus saves."""
STRIDE = (0.15, 0.004)
"""Length of the first and the last step, in parts of the worth of the depths around."""
HIGHEST = 4.0
"""What a depth may become worth on the way, in parts of the worth around it at the start."""
COARSE = 24.0
"""Nodes to half a band while it climbs; the bound itself is taken on a finer grid."""


@dataclass(frozen=True)
class Focus:
    """Foci that are alike.

    Args:
        aperture: a, effective, mm, > 0.
        focus_range: nearest and farthest focus, mm, > 0.
        count: how many, >= 1.
    """

    aperture: float
    focus_range: tuple[float, float]
    count: int


def best_worth(depths: Depths, foci: tuple[Focus, ...], baseline: float) -> Float[np.ndarray, " z"]:
    """Give a worth v of each depth, mm^2, with nearly the highest sum_z v_z - sum over foci of the most it saves, 0 <= v <= s.

    Args:
        depths: where the score is taken.
        foci: at least one.
        baseline: g, effective, mm, >= 0; without one (0) only the foci measure.
    """
    ceiling = _ceiling(depths, foci, baseline)
    start, price = _equal_start(depths, foci, ceiling)
    return _climb(depths, foci, ceiling, start, price)


def _ceiling(depths: Depths, foci: tuple[Focus, ...], baseline: float) -> Float[np.ndarray, " z"]:
    """Give what a depth can cost at most: stereo, or the farthest focus there is."""
    by_focus = np.min(
        [
            depths.slope / focus.aperture**2 * np.max([(depths.depth - end) ** 2 for end in focus.focus_range], axis=0)
            for focus in foci
        ],
        axis=0,
    )
    # A depth that is always in focus is worth nothing; a hair above keeps all that divides by it finite.
    by_focus = np.maximum(by_focus, 1e-12 * by_focus.max() + 1e-300)
    return np.minimum(depths.stereo / baseline**2, by_focus) if baseline > 0 else by_focus


def _equal_start(
    depths: Depths, foci: tuple[Focus, ...], ceiling: Float[np.ndarray, " z"]
) -> tuple[Float[np.ndarray, " z"], float]:
    """Give the worth for foci of equal apertures, and what the last of them saves."""
    counts = np.array([focus.count for focus in foci])
    total = int(counts.sum())
    aperture = float(np.sqrt(counts @ np.square([focus.aperture for focus in foci]) / total))
    widest = (min(focus.focus_range[0] for focus in foci), max(focus.focus_range[1] for focus in foci))
    stretch = stretch_costs(depths, aperture, widest)
    scores = best_scores(ceiling, stretch, total)
    price = max(float(scores[-2] - scores[-1]), 1e-12 * float(scores[0]))
    return worth_of_depths(ceiling, stretch, price), price


def _climb(
    depths: Depths,
    foci: tuple[Focus, ...],
    ceiling: Float[np.ndarray, " z"],
    worth: Float[np.ndarray, " z"],
    price: float,
) -> Float[np.ndarray, " z"]:
    # The potentials jump from depth to depth: a step is measured by their mean over a tenth of the depths.
    around = max(3, len(worth) // 10) | 1
    scale = np.convolve(np.pad(worth, around // 2, mode="edge"), np.full(around, 1 / around), mode="valid")
    scale = np.clip(scale, 1e-6 * ceiling, ceiling)
    # The rows of the grid must hold whatever the worth may become on the way.
    grids = [
        (focus_grid(depths, np.minimum(ceiling, HIGHEST * scale), focus.aperture, focus.focus_range, COARSE), focus)
        for focus in foci
    ]
    x, ceiling_x = worth / scale, np.minimum(ceiling / scale, HIGHEST)
    best, best_x = -np.inf, x
    drift = np.zeros_like(x)
    spread = np.zeros_like(x)
    for step in range(STEPS):
        done = step / (STEPS - 1)
        width = price * SMOOTHING[0] * (SMOOTHING[1] / SMOOTHING[0]) ** done
        value, gradient = _value_and_gradient(grids, x * scale, width)
        if value > best:
            best, best_x = value, x
        gradient = gradient * scale / scale.mean()
        drift = 0.9 * drift + 0.1 * gradient
        spread = 0.99 * spread + 0.01 * gradient**2
        stride = STRIDE[0] * (STRIDE[1] / STRIDE[0]) ** done
        move = (drift / (1 - 0.9 ** (step + 1))) / (np.sqrt(spread / (1 - 0.99 ** (step + 1))) + 1e-3)
        x = np.clip(x + stride * move, 0.0, ceiling_x)
    return best_x * scale


def _value_and_gradient(
    grids: list[tuple[FocusGrid, Focus]], worth: Float[np.ndarray, " z"], width: float
) -> tuple[float, Float[np.ndarray, " z"]]:
    """Give the bound of a worth on a coarse grid, and the gradient of the same with a soft maximum of that width, mm^2."""
    value, gradient = float(worth.sum()), np.ones_like(worth)
    for grid, focus in grids:
        saved = grid.saved(worth, focus.aperture)
        of_node = saved.sum(1)
        value -= focus.count * float(of_node.max())
        share = np.exp((of_node - of_node.max()) / width)
        share *= focus.count / share.sum()
        if grid.from_the_first:
            gradient[: len(saved.T)] -= share @ (saved > 0)
        else:
            gradient -= np.bincount(grid.depth_index.ravel(), ((saved > 0) * share[:, None]).ravel(), len(worth))
    return value, gradient
