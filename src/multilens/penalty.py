"""A smooth price for taking room that is not there: what makes lenses part and come inside during the search.

A penalty is made for a question once and then asked for many layouts. It is 0 where a layout is feasible: `area_penalty` up to
2e-4 of a body's radius, `distance_penalty` exactly, on a back of many edges up to half a cell of its samples. It is without
unit: lengths count in units of the largest body that a lens can have, or that the back has room for.
"""

from collections.abc import Callable
from math import pi, sqrt

import torch
from torch import Tensor

from multilens.constraints import body_radius, pair_room, quick_room
from multilens.geometry.overlap import outside_area, overlap_area
from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.question import Question

Price = Callable[[Layout], Tensor]
"""From layouts to one number >= 0 each, [*batch], differentiable in positions and radii."""


def distance_penalty(question: Question) -> Price:
    """Price each missing distance by its square: sum (missing between bodies)^2 + sum (missing to outline and keep-outs)^2."""
    room = quick_room(question.back)
    unit = _unit(question)

    def price(layout: Layout) -> Tensor:
        apart = pair_room(layout, question.lenses, question.gap)
        inside = room(layout.position) - body_radius(layout, question.lenses).unsqueeze(-1)
        missing = torch.cat([apart, inside.flatten(-2)], dim=-1).clamp(max=0) / unit
        return missing.square().sum(-1)

    return price


def area_penalty(question: Question) -> Price:
    """Price each area that is taken twice or off the back: sum of the overlaps of bodies + sum of the areas outside.

    An area does not change while one shape lies wholly inside the other, so that a body in the middle of a large keep-out, or
    of a larger body, is not told where to go. Starts stand clear of keep-outs; `distance_penalty` has no such blind spot.

    Bodies are grown by half the gap against each other, and each keep-out by its clearance, so that the areas vanish where the
    distances are kept.
    """
    region = question.back.region()
    unit = _unit(question)

    def price(layout: Layout) -> Tensor:
        radius = body_radius(layout, question.lenses)
        first, second = pair_indices(layout.count, radius.device)
        apart_radius = radius + question.gap / 2
        twice = overlap_area(
            layout.position[..., first, :],
            apart_radius[..., first],
            layout.position[..., second, :],
            apart_radius[..., second],
        )
        return (twice.sum(-1) + outside_area(layout.position, radius, region).sum(-1)) / unit**2

    return price


def _unit(question: Question) -> float:
    """Give the radius of the largest body, or of bodies that would fill the back if that is less, mm."""
    largest = max(lens.aperture_radius[1] + lens.clearance for lens in question.lenses)
    return min(largest, sqrt(question.back.region().area / (pi * len(question.lenses))))
