"""What a packing promises before its lenses are focused: its longest baseline and the sum of its apertures say nearly all.

A lens whose error is h Z abs(Z - Zf) serves a stretch of depths of length l with a mean square of h^2 l^2 Z^2 / 12. Where
stretches are short, let l = L(Z) / h. The score is the integral of w Z^2 L^2 / 12, and since all stretches together fill the
range, the integral of 1/L is S = sum 1/h. So the least is reached for L ~ (w Z^2)^(-1/3):

J = (integral of (w Z^2)^(1/3) dZ)^3 / (12 S^2).

It takes no more than the sum, whichever lens is focused where. Stereo serves the depths before some Z_0, which is the best.

Reference:
    P. Panter and W. Dite, Quantization distortion in pulse-count modulation with nonuniform spacing of levels (1951).
"""

import numpy as np
from jaxtyping import Float

from multilens.search.gapless import Gapless

DEAR = 1e90
"""1/mm; a gain of stereo or a slope of defocus that is no better than none, and whose square is a number."""


class Promise:
    """The score that layouts come to at their best foci, nearly.

    Args:
        depths: mm, in any order, two unlike ones at least.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[np.ndarray, " z"], weights: Float[np.ndarray, " z"]) -> None:
        mean = Gapless(depths, weights)
        second, _, fourth = mean.integrals(mean.edge)
        length = np.diff(mean.edge)
        eased = (np.diff(second) / length) ** (1 / 3) * length
        self.by_stereo = fourth
        """Integral of w Z^4 up to each depth at which lenses may take over."""
        self.by_lenses = np.append(eased[::-1].cumsum()[::-1], 0.0) ** 3 / 12
        """J S^2 of the depths from there on."""

    def __call__(self, gain: Float[np.ndarray, " b"], width: Float[np.ndarray, " b"]) -> Float[np.ndarray, " b"]:
        """Give the scores, mm^2.

        Args:
            gain: of stereo, err = gain Z^2, 1/mm; infinite where there is none.
            width: S, the sum of 1/h over all foci, mm; 0 where there are none.
        """
        square_gain, square_width = np.minimum(gain, DEAR)[:, None] ** 2, np.maximum(width, 1 / DEAR)[:, None] ** 2
        return (square_gain * self.by_stereo + self.by_lenses / square_width).min(-1)
