"""The least that the worst of all depths can be: depths left by stereo as intervals, pierced by as few foci as there are.

With squared errors times the factors q of the depths, a score t allows stereo of the baseline g at every Z with q Z^4 / g^2 <= t,
and a focus Zf of the aperture a at every Z with abs(Z - Zf) <= r(Z) = a sqrt(t / q) / Z. So Zf serves those depths whose interval
[Z - r, Z + r] it lies in. The fewest points that pierce a set of intervals are found by always taking the least right end of
those that are left. If they are more than there are foci, no layout scores t or less. Baseline and apertures are effective ones,
as in `multilens.bounds.cut`, and no less than those of any layout.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

HALVINGS = 100
"""Of a range of scores that spans many powers of ten."""

SAFE = 1e-9
"""Part by which a bound is lowered, beyond what floats lose."""


@dataclass(frozen=True, eq=False)
class Serving:
    """What serves the depths, at its very best.

    Args:
        baseline: g, the longest effective one, mm; 0 without stereo.
        aperture: a, the widest effective one, mm; 0 without defocus.
        foci: how many foci there are.
        focus_range: nearest and farthest that any may have, mm.
    """

    baseline: float
    aperture: float
    foci: int
    focus_range: tuple[float, float]


def least_worst(depths: Float[np.ndarray, " z"], factor: Float[np.ndarray, " z"], serving: Serving) -> float:
    """Give a number below which the largest of the squared errors times their factors is for no layout.

    Args:
        depths: Z, mm, > 0, at least one.
        factor: q of each, > 0.
        serving: no less than what any layout has.
    """
    if not _all_served(depths, factor, serving, np.inf):
        return np.inf
    low, high = 0.0, float((factor * depths**4).max())
    while not _all_served(depths, factor, serving, high):
        low, high = high, 1024 * high
    for _ in range(HALVINGS):
        middle = (low * high) ** 0.5 if low else high / 1024
        if _all_served(depths, factor, serving, middle):
            high = middle
        else:
            low = middle
    return low * (1 - SAFE)


def _all_served(
    depths: Float[np.ndarray, " z"], factor: Float[np.ndarray, " z"], serving: Serving, score: float
) -> bool:
    left = factor * depths**4 > score * serving.baseline**2 if serving.baseline else np.ones(len(depths), dtype=bool)
    if not left.any() or not serving.aperture:
        return not left.any()
    near, far = serving.focus_range
    reach = serving.aperture * np.sqrt(score / factor[left]) / depths[left]
    begin, end = np.maximum(depths[left] - reach, near), np.minimum(depths[left] + reach, far)
    if (begin > end).any():
        return False
    for _ in range(serving.foci):
        later = begin > end.min()
        begin, end = begin[later], end[later]
        if not len(end):
            return True
    return False
