"""From nearly feasible to feasible but for rounding: room that is missing is taken off the apertures."""

import torch

from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.search.limits import Limits

ROUNDS = 6
"""What a lens at its smallest aperture cannot give, the other of a pair gives in the next round."""

SPARE = 1e-12
"""Part of the back's diagonal that is taken off besides, more than rounding takes."""


def tighten(limits: Limits, layout: Layout) -> Layout:
    """Make apertures smaller where lenses overlap or leave the back, as far as their bounds allow; places and foci stay.

    Args:
        limits: exact ones.
        layout: in float64, one or a batch.
    """
    lenses = limits.question.lenses
    least = torch.tensor([lens.aperture_radius[0] for lens in lenses], dtype=torch.float64)
    first, second = pair_indices(layout.count)
    spare = SPARE * limits.question.back.size
    radius = layout.aperture_radius
    for _ in range(ROUNDS):
        room = limits(Layout(layout.position, radius, layout.focus))
        lacking = (spare - room.inside.amin(-1)).clamp(min=0)
        missing = (spare - room.apart).clamp(min=0)
        if not (missing > spare).any() and not (lacking > spare).any():
            break
        # Each of a pair gives half, or all of what the other cannot.
        gives = (radius - least).clamp(min=0)
        half = torch.minimum(missing / 2, gives[..., first]), torch.minimum(missing / 2, gives[..., second])
        by_first, by_second = missing - half[1], missing - half[0]
        for lens in range(layout.count):
            mine = [by_first[..., first == lens], by_second[..., second == lens], lacking[..., lens : lens + 1]]
            lacking[..., lens] = torch.cat(mine, dim=-1).amax(-1)
        radius = (radius - lacking).maximum(least)
    return Layout(layout.position, radius, layout.focus)
