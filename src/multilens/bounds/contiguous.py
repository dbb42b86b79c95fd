"""Foci of equal apertures: the best of them exactly, by dynamic programming along the depths.

Equal foci share depths out in stretches: after dividing by Z all their errors are |Z - Zf| / a, so the nearest focus is the
best one, and it beats stereo over a stretch too, where |Z - Zf| / a < Z / g. Whatever lies between is left to stereo. So the best
score is that of the cheapest way through the depths, one step at a time by stereo or one stretch at a time by a focus.
"""

import numpy as np
from jaxtyping import Float

from multilens.bounds.cut import Depths


def stretch_costs(depths: Depths, aperture: float, focus_range: tuple[float, float]) -> Float[np.ndarray, "n n"]:
    """Give the least weighted squared error of one focus over depths i to j - 1, mm^2; infinite where j <= i.

    The best focus of a stretch is sum w Z^3 / sum w Z^2, held to its range.

    Args:
        depths: where the score is taken.
        aperture: a, effective, mm, > 0.
        focus_range: nearest and farthest focus, mm, > 0.
    """
    second, third, fourth = (
        np.concatenate([[0.0], np.cumsum(depths.weight * depths.depth**power)]) for power in (2, 3, 4)
    )
    start, end = np.triu_indices(len(second), 1)
    m2, m3, m4 = (moment[end] - moment[start] for moment in (second, third, fourth))
    focus = np.clip(m3 / m2, *focus_range)
    cost = np.full((len(second), len(second)), np.inf)
    cost[start, end] = np.maximum(m4 - 2 * focus * m3 + focus**2 * m2, 0.0) / aperture**2
    return cost


def best_scores(
    stereo: Float[np.ndarray, " z"], stretch: Float[np.ndarray, "n n"], count: int
) -> Float[np.ndarray, " k"]:
    """Give the least score with 0, 1, ..., count foci, mm^2.

    Args:
        stereo: weighted squared error of stereo at each depth, mm^2, finite.
        stretch: as `stretch_costs` gives it, n = z + 1.
        count: of foci, >= 0.
    """
    by_stereo = np.concatenate([[0.0], np.cumsum(stereo)])
    least = by_stereo
    scores = [least[-1]]
    for _ in range(count):
        ended = (least[:, None] + stretch).min(0)
        # After the stretch any number of depths may be left to stereo, the running minimum; or the focus is not used at all.
        least = np.minimum(np.minimum.accumulate(np.minimum(ended, least) - by_stereo) + by_stereo, least)
        scores.append(least[-1])
    return np.array(scores)


def worth_of_depths(
    stereo: Float[np.ndarray, " z"], stretch: Float[np.ndarray, "n n"], price: float
) -> Float[np.ndarray, " z"]:
    """Give what each depth adds to the least score of the depths before it, when every focus has a price, mm^2.

    These are potentials of the shortest way through the depths: over a stretch they add up to its cost and the price at most,
    and none exceeds stereo. The mean of those from the near end and from the far end is less ragged.

    Args:
        stereo: weighted squared error of stereo at each depth, mm^2, finite.
        stretch: as `stretch_costs` gives it, n = z + 1.
        price: of a focus, mm^2, >= 0.
    """
    from_near = np.diff(_least(stereo, stretch, price))
    from_far = np.diff(_least(stereo[::-1], stretch[::-1, ::-1].T, price))[::-1]
    return np.clip((from_near + from_far) / 2, 0.0, stereo)


def _least(stereo: Float[np.ndarray, " z"], stretch: Float[np.ndarray, "n n"], price: float) -> Float[np.ndarray, " n"]:
    least = np.zeros(len(stereo) + 1)
    for end in range(1, len(least)):
        least[end] = min(least[end - 1] + stereo[end - 1], float((least[:end] + stretch[:end, end]).min()) + price)
    return least
