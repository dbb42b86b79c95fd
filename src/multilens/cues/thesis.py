"""The cues of the thesis: stereo of every pair and defocus of every lens, each with a scalar for its noise."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.cues.cue import Measurement
from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.defocus import focused_sensitivity
from multilens.optics.many_views import view_information
from multilens.optics.stereo import pair_angular_noise

NANOMETRE = 1e-6
"""mm"""


@dataclass(frozen=True)
class PairStereo:
    """Stereo of every pair of lenses by the distance of their centres: err = Z^2 / b * sqrt((n1/f1)^2/2 + (n2/f2)^2/2).

    It is a factored cue: with a common noise the widest pair is the best at every depth.

    Reference:
        Thesis, equation 4.3, for each pair; unequal lenses by the root mean square of their angular noises.
    """

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the pairs, 1-2, 1-3, ..., 2-3, ..."""
        pairs = pair_indices(len(lenses)).T.tolist()
        return tuple(Measurement("stereo", (i, j), None, f"stereo {i + 1}-{j + 1}") for i, j in pairs)

    def gain(self, layout: Layout, lenses: Sequence[Lens]) -> Float[Tensor, "*batch p"]:
        """Give the angular noise of every pair over its baseline, 1/mm; lenses closer than a nanometre count as that far apart."""
        noise = self.noise(lenses, layout.position.dtype).to(layout.position.device)
        return noise / pair_distance(layout.position).clamp(min=NANOMETRE)

    def noise(self, lenses: Sequence[Lens], dtype: torch.dtype) -> Float[Tensor, " p"]:
        """Give the angular noise of every pair, rad."""
        each = torch.tensor([lens.disparity_noise / lens.focal_length for lens in lenses], dtype=dtype)
        first, second = pair_indices(len(lenses))
        return pair_angular_noise(each[first], each[second])

    def shape(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give Z^2, mm^2."""
        return depths**2

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give the depth error of every pair, mm."""
        return self.gain(layout, lenses).unsqueeze(-1) * self.shape(depths)

    def precision(self, layout: Layout, lenses: Sequence[Lens]) -> Float[Tensor, "n 1"]:
        """Give one over the variance of the direction in which each lens sees a point, rad^-2.

        The noise of a lens is that of the difference of two such lenses, which has twice the variance of each.
        """
        return _column([2 * (lens.focal_length / lens.disparity_noise) ** 2 for lens in lenses], layout).unsqueeze(-1)

    def information(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch z"]:
        """Give what all lenses tell together as views of one point, 1/mm^2; one pair gives 1 / err^2."""
        baseline = pair_distance(layout.position).clamp(min=NANOMETRE)
        of_inverse = view_information(baseline, self.precision(layout, lenses))
        return of_inverse / depths**4


@dataclass(frozen=True)
class LensDefocus:
    """Differential defocus of every lens and tier: err = Z abs(Z - Zf) n / (2 A f).

    Reference:
        Thesis, equation 5.5 in the form of its chapter 6, for each lens.
    """

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the lenses, and their tiers where a lens has several."""
        return tuple(
            Measurement("defocus", (i,), t, f"defocus {i + 1}" + (f" tier {t + 1}" if lens.tiers > 1 else ""))
            for i, lens in enumerate(lenses)
            for t in range(lens.tiers)
        )

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every lens and tier, mm; it is zero where the depth is in focus."""
        focal_length, radius, focus = (part.unsqueeze(-1) for part in self._tiers(layout, lenses))
        return focused_sensitivity(depths, radius, focal_length, focus)

    def slope_and_focus(
        self, layout: Layout, lenses: Sequence[Lens]
    ) -> tuple[Float[Tensor, "*batch k"], Float[Tensor, "*batch k"]]:
        """Give h and Zf of every measurement: its error is Z h abs(Z - Zf).

        Returns:
            h = n / (2 A f), 1/mm, and Zf, mm.
        """
        focal_length, radius, focus = self._tiers(layout, lenses)
        return 1 / (2 * radius * focal_length), focus

    def _tiers(self, layout: Layout, lenses: Sequence[Lens]) -> tuple[Tensor, Tensor, Tensor]:
        """Give focal length, aperture radius and focus of every measurement.

        Sensitivity times noise: the focal length is counted in units of the noise, which saves a pass over all depths.
        """
        focal_length = _column([lens.focal_length / lens.blur_noise for lens in lenses], layout)
        if all(lens.tiers == 1 for lens in lenses):
            return focal_length.expand_as(layout.aperture_radius), layout.aperture_radius, layout.focus[..., 0]
        tiers = [(i, t) for i, lens in enumerate(lenses) for t in range(lens.tiers)]
        lens_index, tier_index = torch.tensor(tiers, dtype=torch.long, device=layout.position.device).T
        return (
            focal_length[lens_index],
            layout.aperture_radius[..., lens_index],
            layout.focus[..., lens_index, tier_index],
        )


def _column(numbers: list[float], layout: Layout) -> Float[Tensor, " n"]:
    return torch.tensor(numbers, dtype=layout.position.dtype, device=layout.position.device)
