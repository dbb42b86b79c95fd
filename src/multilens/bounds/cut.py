"""A cut: a worth for every depth, from which a bound on the score follows for any apertures and any baseline.

With `c` the squared error of one focus and `s` that of stereo, each times the depth's weight, and any worth v >= 0,

    sum_z min(s_z, min_k c_kz)  >=  sum_z min(v_z, s_z)  -  sum_k max over Zf of sum_z max(v_z - c_z(Zf), 0)

since min(s, c_1, ..., c_K) >= min(v, s) - sum_k max(v - c_k, 0) for any numbers. The first sum falls with the baseline alone, each
term of the second, what one focus can save, rises with one lens' aperture alone. All is in millimetres and mm^2.

Apertures and baselines are effective ones, so that all noises are 1: a = 2 A f / blur noise, g = b / pair noise. Then
c = w Z^2 (Z - Zf)^2 / a^2 and s = w Z^4 / g^2.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

FINE = 48.0
"""Nodes to half the width of the band of depths that a focus serves: the bound loses about 1.5 / (2 FINE)^2 of a saving."""

MOST_PLACES = 50_000
"""Nodes times depths of a grid of foci; beyond it the grid is coarser than is asked, which weakens the bound and nothing else."""

FEWEST_NODES = 48


@dataclass(frozen=True, eq=False)
class Depths:
    """The depths at which the score is taken.

    Args:
        depth: Z, mm, > 0, ascending.
        weight: w, > 0, summing to 1.
    """

    depth: Float[np.ndarray, " z"]
    weight: Float[np.ndarray, " z"]

    @cached_property
    def stereo(self) -> Float[np.ndarray, " z"]:
        """The weighted squared error of stereo at an effective baseline of 1 mm, w Z^4."""
        return self.weight * self.depth**4

    @cached_property
    def slope(self) -> Float[np.ndarray, " z"]:
        """What times (Z - Zf)^2 is the weighted squared error of defocus at an effective aperture of 1 mm, w Z^2."""
        return self.weight * self.depth**2


@dataclass(frozen=True, eq=False)
class FocusGrid:
    """Foci from nearest to farthest, each with a window of depths that holds all it can serve; the windows are equally long.

    Args:
        depth_index: which depths a focus may serve.
        cost: weighted squared error of each node at each of its depths at an effective aperture of 1 mm, mm^4, lowered so
            that the nodes stand for all foci between them: see `focus_grid`.
    """

    depth_index: Int[np.ndarray, "f s"]
    cost: Float[np.ndarray, "f s"]

    def saved(self, worth: Float[np.ndarray, " z"], aperture: float) -> Float[np.ndarray, "f s"]:
        """Give what each node saves at each of its depths with an effective aperture a, max(v - c / a^2, 0), mm^2."""
        saved = self.cost * (-1 / aperture**2)
        saved += worth[: saved.shape[1]] if self.from_the_first else worth[self.depth_index]
        np.maximum(saved, 0.0, out=saved)
        return saved

    @cached_property
    def from_the_first(self) -> bool:
        """Whether every node's window begins at the first depth, so that all are the same."""
        return bool((self.depth_index == np.arange(self.depth_index.shape[1])).all())


def focus_grid(
    depths: Depths,
    worth: Float[np.ndarray, " z"],
    aperture: float,
    focus_range: tuple[float, float],
    fine: float = FINE,
) -> FocusGrid:
    """Lay nodes u over a range of foci so that no focus saves more than the node that saves most.

    At Zf = m + t, with m halfway between the nodes m - d and m + d, a depth's cost is
    k (Z - m - t)^2 >= k ((Z - m)^2 - 2 t (Z - m)). What is saved with the latter is convex in t, so it is largest at one of the
    two nodes, where that cost is k ((Z - u)^2 - d^2).

    Args:
        depths: where the score is taken.
        worth: v, mm^2; the rows hold every depth at which it may exceed the cost.
        aperture: a, effective, mm, > 0, the largest for which the grid is used.
        focus_range: nearest and farthest focus, mm, > 0.
        fine: nodes to half the width of a typical band.
    """
    # A focus u serves only depths with |Z - u| < half_band Z + d.
    half_band = np.sqrt(worth / depths.slope) * (aperture / depths.depth)
    widest = float(half_band.max())
    near, far = focus_range
    count = 1
    if far > near:
        typical = max(float(half_band @ worth) / max(float(worth.sum()), 1e-300), 1e-9)
        count = int(np.clip(np.log(far / near) * fine / typical, FEWEST_NODES, MOST_PLACES))
    node, reach, index = _windows(depths.depth, focus_range, widest, count)
    if index.size > MOST_PLACES and count > FEWEST_NODES:
        count = max(FEWEST_NODES, MOST_PLACES // index.shape[1])
        node, reach, index = _windows(depths.depth, focus_range, widest, count)
    cost = depths.slope[index] * ((depths.depth[index] - node[:, None]) ** 2 - reach[:, None] ** 2)
    return FocusGrid(index, cost)


def _windows(
    depth: Float[np.ndarray, " z"], focus_range: tuple[float, float], widest: float, count: int
) -> tuple[Float[np.ndarray, " f"], Float[np.ndarray, " f"], Int[np.ndarray, "f s"]]:
    """Give nodes u, half the way d to the farther neighbour of each, mm, and the depths with |Z - u| < widest Z + d."""
    node = np.geomspace(*focus_range, count)
    # Rounded up, so that the reaches of two neighbours cover what lies between them.
    between = np.diff(node) / 2 * (1 + 1e-9)
    reach = np.maximum(np.append(between, 0.0), np.insert(between, 0, 0.0))
    first = np.searchsorted(depth, (node - reach) / (1 + widest) * (1 - 1e-9))
    last = np.full(count, len(depth))
    if widest < 0.999:
        last = np.searchsorted(depth, (node + reach) / (1 - widest) * (1 + 1e-9), side="right")
    window = max(1, int((last - first).max()))
    return node, reach, np.minimum(first, len(depth) - window)[:, None] + np.arange(window)


def most_saved(
    depths: Depths, worth: Float[np.ndarray, " z"], aperture: float, focus_range: tuple[float, float]
) -> float:
    """Give no less than the most that one focus saves, max over Zf of sum_z max(v_z - c_z(Zf), 0), mm^2.

    Args:
        depths: where the score is taken.
        worth: v, mm^2, >= 0.
        aperture: a, effective, mm, > 0.
        focus_range: nearest and farthest focus, mm, > 0.
    """
    return float(focus_grid(depths, worth, aperture, focus_range).saved(worth, aperture).sum(1).max())


def savings(
    depths: Depths,
    worth: Float[np.ndarray, " z"],
    apertures: Float[np.ndarray, " a"],
    focus_range: tuple[float, float],
    evaluated: int = 33,
) -> Float[np.ndarray, " a"]:
    """Give no less than the most that one focus saves at each of many apertures, mm^2.

    For one focus max(v - x k (Z - Zf)^2, 0) is convex in x = 1 / a^2, and so are sums and maxima of such: a chord between two
    apertures lies on the safe side.

    Args:
        depths: where the score is taken.
        worth: v, mm^2, >= 0.
        apertures: a, effective, mm, > 0, ascending.
        focus_range: nearest and farthest focus, mm, > 0.
        evaluated: at how many of them it is computed rather than interpolated.
    """
    at = np.unique(np.linspace(0, len(apertures) - 1, evaluated).round().astype(int))
    grid = focus_grid(depths, worth, float(apertures[-1]), focus_range)
    found = np.array([grid.saved(worth, float(a)).sum(1).max() for a in apertures[at]])
    return np.interp(-(apertures**-2.0), -(apertures[at] ** -2.0), found)


def stereo_left(
    depths: Depths, worth: Float[np.ndarray, " z"], baseline: Float[np.ndarray, " m"]
) -> Float[np.ndarray, " m"]:
    """Give sum_z min(v_z, s_z) for effective baselines g, mm^2; a baseline of 0 leaves all of v."""
    with np.errstate(divide="ignore"):
        scale = baseline[:, None] ** -2.0
    return np.minimum(worth, depths.stereo * scale).sum(1)
