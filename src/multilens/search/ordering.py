"""Which of unlike lenses is focused before which: two change places along the depths as long as that helps."""

from math import isinf

import numpy as np
from jaxtyping import Float, Int

from multilens.search.gapless import Gapless

ROUNDS = 6
"""In which foci and the ends of their stretches follow each other; what is left is the same for all orders."""

PROGRESS = 1e-6
"""Part of the score by which an exchange must help."""


class Ordering:
    """Orders of lenses along a range of depths without gaps, stereo before the first of them.

    To a first approximation the order does not matter (`multilens.search.promise`): stretches are as long as apertures are wide,
    and the score depends on their sum. What is left is small and is found by trying.

    Args:
        depths: mm, in any order, two unlike ones at least.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[np.ndarray, " z"], weights: Float[np.ndarray, " z"]) -> None:
        mean = Gapless(depths, weights)
        self.moments, self.edge = mean.integrals, mean.edge
        density = np.diff(self.moments(self.edge)[0]) / np.diff(self.edge)
        self.eased = np.concatenate([[0.0], (density ** (1 / 3) * np.diff(self.edge)).cumsum()])
        """A measure of depth by which the stretches of the best foci are as long as their apertures are wide."""

    def improved(
        self, gain: float, slope: Float[np.ndarray, " f"], tip: Float[np.ndarray, " f"]
    ) -> Int[np.ndarray, " f"]:
        """Give the order of the foci, the nearest first, after the best exchanges of two of them.

        Args:
            gain: of stereo, err = gain Z^2, 1/mm; infinite where there is none.
            slope: of defocus of each focus, err = slope Z abs(Z - Zf), 1/mm.
            tip: the foci now, mm.
        """
        order = tip.argsort(kind="stable")
        nearest = order[0]
        taken_over = slope[nearest] * tip[nearest] / (slope[nearest] + gain)
        begin = float(taken_over.clip(self.edge[0], self.edge[-1]))
        first, second = np.triu_indices(len(order), 1)
        least, each = self._scores(gain, slope[order][None], begin)[0], np.arange(len(first))
        while len(first):
            tried = np.tile(order, (len(first), 1))
            tried[each, first], tried[each, second] = order[second], order[first]
            scores = self._scores(gain, slope[tried], begin)
            best = scores.argmin()
            if not scores[best] < least * (1 - PROGRESS):
                break
            least, order = scores[best], tried[best]
        return order

    def _scores(self, gain: float, slope: Float[np.ndarray, "b f"], begin: float) -> Float[np.ndarray, " b"]:
        """Give what each sequence of slopes comes to, mm^2, if the first of them takes over from stereo about `begin`."""
        width = (1 / slope).cumsum(-1)
        eased = np.interp(begin, self.edge, self.eased)
        end = np.interp(eased + (self.eased[-1] - eased) * width / width[:, -1:], self.eased, self.edge)
        cut = np.column_stack([np.full(len(end), begin), end])
        for _ in range(ROUNDS):
            second, third, _ = self._within(cut)
            rise = slope * third / np.where(second > 0, second, 1)
            # Neighbours are equally good where their Vs cross; the first is as good as stereo where it begins.
            cut[:, 1:-1] = (rise[:, 1:] + rise[:, :-1]) / (slope[:, 1:] + slope[:, :-1])
            cut[:, 0] = (rise[:, 0] / (slope[:, 0] + gain)).clip(self.edge[0], self.edge[-1])
        second, third, fourth = self._within(cut)
        spread = fourth - third**2 / np.where(second > 0, second, 1)
        by_stereo = 0.0 if isinf(gain) else gain**2 * self.moments(cut[:, 0])[2]
        return (slope**2 * spread).sum(-1) + by_stereo

    def _within(self, cut: Float[np.ndarray, "b c"]) -> Float[np.ndarray, "3 b f"]:
        """Give the integrals of w Z^2, w Z^3 and w Z^4 between each cut and the next."""
        return np.diff(self.moments(cut.ravel()).reshape(3, *cut.shape), axis=-1)
