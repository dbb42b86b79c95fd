"""The score as if depths were a range without gaps: smooth where single depths leave ripples that hold a polish fast.

Divided by the depth, defocus is a V and stereo a line, which is a V with its tip at 0. Between two of their crossings one of them
is the least, and its share of the score is an integral over the depths. Of single depths now one, now another changes hands as an
aperture grows, and each time the score has a kink: between two kinks there may be a local optimum that means nothing.
"""

from functools import cache

import numpy as np
from jaxtyping import Float

from multilens.cues import NANOMETRE

DEGREE = np.array([[3.0], [4.0], [5.0]])


class Gapless:
    """The mean of the least squared error over a range of depths.

    Each depth's weight is spread evenly from half way to the depth before to half way to the next.

    Args:
        depths: mm, in any order, two unlike ones at least.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[np.ndarray, " z"], weights: Float[np.ndarray, " z"]) -> None:
        depth, which = np.unique(depths, return_inverse=True)
        middle = (depth[1:] + depth[:-1]) / 2
        first, last = max(2 * depth[0] - middle[0], depth[0] / 2), 2 * depth[-1] - middle[-1]
        self.edge = np.concatenate([[first], middle, [last]])
        self.density = np.bincount(which, weights) / np.diff(self.edge)
        whole = self.density * np.diff(_powers(self.edge))
        self.begun = np.cumsum(whole, axis=1) - whole - self.density * _powers(self.edge[:-1])
        """What the integrals of w Z^2, w Z^3 and w Z^4 are at a depth of 0, were each depth's part of the range to go on."""

    def __call__(
        self, slope: Float[np.ndarray, " k"], tip: Float[np.ndarray, " k"]
    ) -> tuple[float, Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
        """Give the mean over Z of the least of (slope Z abs(Z - tip))^2, mm^2, and its derivatives in slope and tip.

        Args:
            slope: of each V, 1/mm, > 0.
            tip: where each is 0, mm.
        """
        rise = slope * tip
        first, second = _pairs(len(slope))
        steeper = slope[first] - slope[second]
        steeper[steeper == 0] = NANOMETRE
        between = (rise[first] + rise[second]) / (slope[first] + slope[second])
        beyond = (rise[first] - rise[second]) / steeper
        cut = np.concatenate([self.edge[:1], between, beyond, self.edge[-1:]])
        np.minimum(np.maximum(cut, self.edge[0], out=cut), self.edge[-1], out=cut).sort()
        middle = (cut[1:] + cut[:-1]) / 2
        winner = (slope[:, None] * np.abs(middle - tip[:, None])).argmin(0)
        upto = self.integrals(cut)
        second_moment, third, fourth = (np.bincount(winner, each, len(slope)) for each in upto[:, 1:] - upto[:, :-1])
        drift = tip * second_moment - third
        spread = np.maximum(fourth + tip * (drift - third), 0)
        return float(slope**2 @ spread), 2 * slope * spread, 2 * slope**2 * drift

    def integrals(self, end: Float[np.ndarray, " c"]) -> Float[np.ndarray, "3 c"]:
        """Give the integrals of w Z^2, w Z^3 and w Z^4 from the first edge up to each end.

        Args:
            end: from the first edge to the last, mm.
        """
        part = np.minimum(self.edge[1:].searchsorted(end, side="right"), len(self.density) - 1)
        return self.begun[:, part] + self.density[part] * _powers(end)


@cache
def _pairs(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.triu_indices(count, 1)


def _powers(depth: Float[np.ndarray, " m"]) -> Float[np.ndarray, "3 m"]:
    """Give Z^3 / 3, Z^4 / 4 and Z^5 / 5."""
    power = np.empty((3, len(depth)))
    np.multiply(depth * depth, depth, out=power[0])
    np.multiply(power[0], depth, out=power[1])
    np.multiply(power[1], depth, out=power[2])
    power /= DEGREE
    return power
