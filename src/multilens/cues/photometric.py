"""The photometric cues: stereo and defocus by one texture, one light and one noise, errors in millimetres of depth."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf

import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn.functional import one_hot

from multilens.cues.cue import Measurement
from multilens.cues.limited import FLOOR
from multilens.cues.limits import PairLimits
from multilens.cues.texture import Sight, refuse_unless_sensors, texture_sight
from multilens.cues.thesis import NANOMETRE, LensDefocus, PairStereo
from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.many_views import view_information
from multilens.optics.photometric import defocus_error, direction_variance, stereo_error
from multilens.ranges import refuse_unless_not_negative, refuse_unless_positive, refuse_unless_share
from multilens.scene import Scene

PER_DIOPTRE = 1e-3
"""1/mm."""


@dataclass(frozen=True)
class PhotometricStereo:
    """Stereo of every pair by the phase of a texture that each lens sees through its own blur and noise.

    err = Z^2 / b sqrt(r_i^2 / w_i^2 + r_j^2 / w_j^2), infinite where a lens has lost the texture or the pair may not be used.
    A lens of several tiers sees with the sharpest of them.

    Args:
        scene: the texture and its light.
        limits: when two lenses may measure together.

    Reference:
        docs/photometric.md, "Stereo"; Cramer-Rao bound on a shift.
    """

    scene: Scene
    limits: PairLimits = field(default_factory=PairLimits)

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the pairs, 1-2, 1-3, ..., 2-3, ...; each lens must have a sensor."""
        refuse_unless_sensors(lenses)
        return PairStereo().measurements(lenses)

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give the depth error of every pair, mm, infinite where it does not measure."""
        variance = self.direction_variance(layout, lenses, depths)
        first, second = pair_indices(len(lenses), depths.device)
        both = variance[..., first, :] + variance[..., second, :]
        seen = both.isfinite() & self.limits.usable(layout, lenses, depths)
        # An infinite variance would make the gradient NaN even where it is not used.
        return stereo_error(depths, _baseline(layout), both.where(seen, 1)).masked_fill(~seen, inf)

    def smooth(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give the depth error of every pair, mm, finite also where the texture is lost, over the limits' smooth factor."""
        variance = self.direction_variance(layout, lenses, depths, smooth=True)
        errors = stereo_error(depths, _baseline(layout), _sum_of_pairs(variance))
        if not self.limits.bind(lenses):
            return errors
        return errors / self.limits.factor(layout, lenses, depths).clamp(min=FLOOR)

    def information(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch z"]:
        """Give what all lenses tell together as views of one point, 1/mm^2, of those pairs that may be used."""
        precision = self.direction_variance(layout, lenses, depths, smooth).reciprocal()
        baseline = _baseline(layout).squeeze(-1)
        return view_information(baseline, precision, self._usable(layout, lenses, depths, smooth)) / depths**4

    def direction_variance(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch n z"]:
        """Give the variance of the direction in which each lens sees a point, rad^2, infinite where it has lost the texture.

        A pair's error is Z^2 / b sqrt(v_i + v_j).

        Args:
            layout: of these lenses.
            lenses: what is known of each.
            depths: Z, mm, > 0.
            smooth: whether a search asks, that wants a differentiable and finite number; else what may be claimed.
        """
        sight = texture_sight(self.scene, 1.0, layout, lenses, depths, smooth)
        reach = sight.frequency * (layout.aperture_radius.unsqueeze(-1) / 2)
        return direction_variance(sight.error_squared(reach, _sharpest(layout.focus, depths)), sight.frequency)

    def _usable(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool
    ) -> Float[Tensor, "*batch p z"] | None:
        if not self.limits.bind(lenses):
            return None
        if smooth:
            return self.limits.factor(layout, lenses, depths).square()
        return self.limits.usable(layout, lenses, depths).to(layout.position)


@dataclass(frozen=True)
class PhotometricDefocus:
    """Differential defocus of every lens and tier: depth by the amplitudes of a texture in two images of different focus.

    err = Z^2 sqrt((r_1^2 + r_2^2) / (k dP)^2 + (2 u e_w/w)^2), infinite where either image has lost the texture. The focus of the
    layout is midway between those of the two images.

    Args:
        scene: the texture and its light.
        power_change_dioptres: dP, by how much the two images differ in optical power (of two sensors, in the inverse of the
            in-focus depth), 1/m, > 0.
        light_share: part of the light that each image gets, > 0 and <= 1: 1 for two exposures one after the other, 0.5 for two
            sensors behind a beam splitter.
        frequency_error: e_w/w, relative error of the texture's frequency, >= 0; 0 where it is known.

    Raises:
        ValueError: a number is out of its range.

    Reference:
        docs/photometric.md, "Defocus"; thesis, equation 8.1.
    """

    scene: Scene
    power_change_dioptres: float
    light_share: float = 1.0
    frequency_error: float = 0.0

    def __post_init__(self) -> None:
        refuse_unless_positive("power_change_dioptres", self.power_change_dioptres)
        refuse_unless_share("light_share", self.light_share)
        refuse_unless_not_negative("frequency_error", self.frequency_error)

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the lenses, and their tiers where a lens has several; each lens must have a sensor."""
        refuse_unless_sensors(lenses)
        return LensDefocus().measurements(lenses)

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every lens and tier, mm, infinite where it has lost the texture."""
        return self._errors(layout, lenses, depths, smooth=False)

    def smooth(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every lens and tier, mm, finite also where the texture is lost."""
        return self._errors(layout, lenses, depths, smooth=True)

    def _errors(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool
    ) -> Float[Tensor, "*batch k z"]:
        sight = texture_sight(self.scene, self.light_share, layout, lenses, depths, smooth)
        sight, radius, focus = _tiers(sight, layout, lenses)
        change = self.power_change_dioptres * PER_DIOPTRE
        reach = sight.frequency * (radius.unsqueeze(-1) / 2)
        defocus = 1 / depths - 1 / focus.unsqueeze(-1)
        first, second = (sight.error_squared(reach, defocus + half) for half in (change / 2, -change / 2))
        both = first + second
        if smooth:
            return defocus_error(depths, defocus, reach**2, change, both, self.frequency_error)
        seen = both.isfinite()
        errors = defocus_error(depths, defocus, reach**2, change, both.where(seen, 1), self.frequency_error)
        return errors.masked_fill(~seen, inf)


def _baseline(layout: Layout) -> Float[Tensor, "*batch p 1"]:
    return pair_distance(layout.position).clamp(min=NANOMETRE).unsqueeze(-1)


def _sharpest(focus: Float[Tensor, "*batch n t"], depths: Float[Tensor, " z"]) -> Float[Tensor, "*batch n z"]:
    """Give 1/Z - 1/Zf of the tier that is nearest to focus at each depth; its size counts, not its sign."""
    if focus.shape[-1] == 1:
        return 1 / depths - 1 / focus
    return (1 / depths - 1 / focus.unsqueeze(-1)).abs().amin(-2)


def _sum_of_pairs(values: Float[Tensor, "*batch n z"]) -> Float[Tensor, "*batch p z"]:
    """Add the two lenses of every pair: one product with a matrix of ones and zeros, where indexing would copy twice."""
    return _takes_part(values.shape[-2], values.dtype, values.device) @ values


@lru_cache(maxsize=64)
def _takes_part(count: int, dtype: torch.dtype, device: torch.device) -> Float[Tensor, "p n"]:
    first, second = pair_indices(count)
    return (one_hot(first, count) + one_hot(second, count)).to(device, dtype)


def _tiers(sight: Sight, layout: Layout, lenses: Sequence[Lens]) -> tuple[Sight, Tensor, Tensor]:
    """Give sight, aperture radius and focus of every lens and tier."""
    if all(lens.tiers == 1 for lens in lenses):
        return sight, layout.aperture_radius, layout.focus[..., 0]
    tiers = [(i, t) for i, lens in enumerate(lenses) for t in range(lens.tiers)]
    lens, tier = torch.tensor(tiers, dtype=torch.long, device=layout.position.device).T
    return sight.of(lens), layout.aperture_radius[..., lens], layout.focus[..., lens, tier]
