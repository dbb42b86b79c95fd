"""From feasible up to rounding to feasible: the last step before a layout is claimed."""

import torch

from multilens.certificate import Certificate, certify
from multilens.layout import Layout
from multilens.question import Question

DECIMALS = 12
"""Kept of each number in mm; what is stored is what is certified."""

SHRINKINGS = 4
"""Tries at taking missing room off the apertures, each ten times as bold as the last, from a hundredth of a nanometre."""


def legalise(question: Question, layout: Layout) -> tuple[Layout, Certificate]:
    """Round a layout to the decimals that are stored, hold it to its bounds, and take missing room off the apertures.

    Args:
        question: what is asked.
        layout: one layout in float64, nearly feasible.

    Returns:
        The layout as it would be stored, and its exact certificate, which says whether it is feasible.
    """
    low, high = (
        torch.tensor(ends, dtype=torch.float64)
        for ends in zip(*(lens.aperture_radius for lens in question.lenses), strict=True)
    )
    near, far = (
        torch.tensor(ends, dtype=torch.float64).unsqueeze(-1) for ends in zip(*question.focus_range, strict=True)
    )
    locks = [lens.position or (None, None) for lens in question.lenses]
    locked = torch.tensor([[place is not None for place in lock] for lock in locks], dtype=torch.bool)
    place = torch.tensor([[place or 0.0 for place in lock] for lock in locks], dtype=torch.float64)
    position = place.where(locked, layout.position.round(decimals=DECIMALS))
    focus = layout.focus.round(decimals=DECIMALS).clamp(min=near, max=far)

    def with_apertures_smaller_by(less: float) -> tuple[Layout, Certificate]:
        radius = (layout.aperture_radius - less).round(decimals=DECIMALS).maximum(low).minimum(high)
        tidy = Layout(position, radius, focus)
        return tidy, certify(question.back, question.lenses, question.focus_range, tidy, question.gap)

    found = with_apertures_smaller_by(0.0)
    for power in range(SHRINKINGS):
        if found[1].feasible:
            break
        found = with_apertures_smaller_by(10.0 ** (power - 11))
    return found
