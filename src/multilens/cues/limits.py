"""Which pairs of lenses may be used at which depths: a mask for the claim, and a smooth factor for the search."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite, radians, tan

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.numerics import steep_rise
from multilens.optics.usable import disparity_parallax, nearest_depth, overlap_parallax

RAMP = 0.1
"""Part of a limit over which the smooth factor rises from 0 to 1."""


@dataclass(frozen=True)
class PairLimits:
    """When two lenses may measure depth together: parallax b / Z at most so much, and depth Z at least so much.

    The fields of view and the near focus are the lenses' own; where a lens does not know one, it limits nothing.

    Args:
        max_disparity: largest shift that the matcher finds, mm on the sensor of the longer lens, > 0; None for any.
        least_overlap: part of the narrower field of view that both lenses must see at a depth, >= 0 and < 1; with 0 it is
            enough that the fields touch.

    Raises:
        ValueError: a number is out of its range.

    Reference:
        docs/pairs.md.
    """

    max_disparity: float | None = None
    least_overlap: float = 0.0

    def __post_init__(self) -> None:
        most = self.max_disparity
        if most is not None and not (isfinite(most) and most > 0):
            raise ValueError(f"max_disparity must be > 0 mm and finite, got {most:g}")
        if not 0 <= self.least_overlap < 1:
            raise ValueError(f"least_overlap must be >= 0 and < 1, got {self.least_overlap:g}")

    def nearest(self, layout: Layout, lenses: Sequence[Lens]) -> Float[Tensor, "*batch p"]:
        """Give the depth from which on each pair may be used, mm, differentiable in the layout."""
        largest_parallax, near_focus = self._of_pairs(lenses, layout)
        return nearest_depth(pair_distance(layout.position), largest_parallax, near_focus)

    def usable(self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]) -> Bool[Tensor, "*batch p z"]:
        """Say which pair may be used at which depth."""
        return depths >= self.nearest(layout, lenses).unsqueeze(-1)

    def bind(self, lenses: Sequence[Lens]) -> bool:
        """Say whether anything limits these lenses: where nothing does every factor is 1."""
        own = any(lens.field_of_view_deg is not None or lens.near_focus is not None for lens in lenses)
        return own or self.max_disparity is not None

    def factor(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch p z"]:
        """Give 0 wherever a pair may not be used, 1 well inside its limits, and a smooth rise in the baseline between them.

        With P the largest parallax it is 1 - (1 - x)^3, x = (1 - b / (P Z)) / RAMP: 1 from a ninth beyond the depth b / P on. An
        error divided by it is never less than it was. What a pair tells, one over its squared error, is multiplied by the square,
        whose derivative is continuous, and 0 where the factor is 0 or 1. The near focus needs no rise: no layout moves it, and a
        search would only pay for what it cannot change.

        Args:
            layout: of these lenses.
            lenses: what is known of each.
            depths: Z, mm, > 0.

        Returns:
            Factors from 0 to 1.
        """
        largest_parallax, near_focus = self._of_pairs(lenses, layout)
        by_parallax = pair_distance(layout.position) / largest_parallax
        within = steep_rise((1 - by_parallax.unsqueeze(-1) / depths) / RAMP)
        return within * (depths >= near_focus.unsqueeze(-1))

    def _of_pairs(self, lenses: Sequence[Lens], layout: Layout) -> tuple[Float[Tensor, " p"], Float[Tensor, " p"]]:
        """Give the largest parallax and the near focus of every pair, which no layout changes."""
        focal_length, tangent, near_focus = torch.tensor(
            [[lens.focal_length, _half_field_tangent(lens), lens.near_focus or 0.0] for lens in lenses],
            dtype=layout.position.dtype,
            device=layout.position.device,
        ).T
        first, second = pair_indices(len(lenses), layout.position.device)
        largest = overlap_parallax(tangent[first], tangent[second], self.least_overlap)
        # Two unknown fields overlap by infinity less infinity.
        largest = largest.nan_to_num(nan=inf, posinf=inf)
        if self.max_disparity is not None:
            disparity = disparity_parallax(focal_length[first], focal_length[second], self.max_disparity)
            largest = largest.minimum(disparity)
        return largest, near_focus[first].maximum(near_focus[second])


def _half_field_tangent(lens: Lens) -> float:
    return inf if lens.field_of_view_deg is None else tan(radians(lens.field_of_view_deg / 2))
