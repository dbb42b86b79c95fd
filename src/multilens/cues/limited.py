"""Stereo that fails where real pairs fail: the thesis' error where a pair may be used, and none elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf

from jaxtyping import Float
from torch import Tensor

from multilens.cues.cue import Measurement
from multilens.cues.limits import PairLimits
from multilens.cues.thesis import NANOMETRE, PairStereo
from multilens.geometry.pairs import pair_distance
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.many_views import view_information

FLOOR = 1e-6
"""Of the smooth factor by which an error is divided: where a pair may not be used, its smooth error is a million times what it
would be, which is as good as none and yet a number."""


@dataclass(frozen=True)
class LimitedStereo:
    """Stereo of every pair where its limits allow it: err = Z^2 / b * sqrt((n1/f1)^2/2 + (n2/f2)^2/2), else infinite.

    The widest pair is the best of those that may be used, and it fails near by, so that pairs are chosen by depth.

    Args:
        limits: when two lenses may measure together.

    Reference:
        docs/pairs.md; thesis, equation 4.3.
    """

    limits: PairLimits = field(default_factory=PairLimits)

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the pairs, 1-2, 1-3, ..., 2-3, ..."""
        return PairStereo().measurements(lenses)

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give the depth error of every pair, mm, infinite where it may not be used."""
        errors = PairStereo()(layout, lenses, depths)
        return errors.masked_fill(~self.limits.usable(layout, lenses, depths), inf)

    def smooth(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give the depth error of every pair divided by the limits' smooth factor, mm."""
        factor = self.limits.factor(layout, lenses, depths).clamp(min=FLOOR)
        return PairStereo()(layout, lenses, depths) / factor

    def information(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch z"]:
        """Give what all lenses tell together as views of one point, 1/mm^2, of those pairs that may be used."""
        if smooth:
            usable = self.limits.factor(layout, lenses, depths).square()
        else:
            usable = self.limits.usable(layout, lenses, depths).to(layout.position)
        precision = PairStereo().precision(layout, lenses)
        baseline = pair_distance(layout.position).clamp(min=NANOMETRE)
        return view_information(baseline, precision, usable) / depths**4
