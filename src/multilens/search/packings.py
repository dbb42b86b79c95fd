"""Where lenses crowd each other: many layouts in which one lens after the other takes the room that is left."""

import numpy as np
import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.layout import Layout
from multilens.question import Question

PLACES = 512
"""Of all that were tried, those that are looked at: a polish moves a lens to where it belongs."""

UNCAPPED = 0.4
"""Part of the lenses that take all the room they can; the others stop at an aperture of their own."""

NEARLY = 0.98
"""Part of the largest body that fits anywhere, which a place has to hold: among those that do it is drawn."""


def packings(
    question: Question, places: Float[Tensor, "p 2"], room: Float[Tensor, " p"], count: int, generator: Generator
) -> Layout:
    """Give layouts filled greedily, the lenses in any order, each as wide as fits or as was drawn for it.

    Args:
        question: what is asked.
        places: where lenses may stand, mm, in no order.
        room: body radius that fits around each, mm.
        count: how many layouts.
        generator: of random numbers, on the processor.

    Returns:
        Layouts whose foci are as far as they may be. Bodies overlap where not even the smallest of one fits any more.
    """
    lenses = question.lenses
    low, high = np.array([lens.aperture_radius for lens in lenses]).T
    clearance = np.array([lens.clearance for lens in lenses])
    fits = room >= (low + clearance).min()
    spot, left = places[fits][:PLACES].numpy(), room[fits][:PLACES].repeat(count, 1).numpy()
    x, y = spot.T.copy()
    cap, uncapped, order = (torch.rand(count, len(lenses), generator=generator).double().numpy() for _ in range(3))
    most = np.minimum(high, np.maximum(left[0].max() - clearance, low))
    cap = np.where(uncapped < UNCAPPED, high, low + (most - low) * np.sqrt(cap))
    place, radius, each = np.zeros((count, len(lenses), 2)), np.zeros((count, len(lenses))), np.arange(count)
    for lens in order.argsort(1).T:
        body = np.minimum(left, (cap[each, lens] + clearance[lens])[:, None])
        drawn = torch.rand(body.shape, generator=generator).numpy()
        at = np.where(body >= NEARLY * body.max(1, keepdims=True), drawn, -1).argmax(1)
        place[each, lens] = spot[at]
        radius[each, lens] = np.clip(body[each, at] - clearance[lens], low[lens], high[lens])
        away = np.sqrt((x - x[at][:, None]) ** 2 + (y - y[at][:, None]) ** 2)
        left = np.minimum(left, away - (radius[each, lens] + clearance[lens])[:, None] - question.gap)
    far = torch.tensor([far for _, far in question.focus_range], dtype=torch.float64)
    foci = far.unsqueeze(-1).repeat(count, 1, max(lens.tiers for lens in lenses))
    return Layout(torch.from_numpy(place), torch.from_numpy(radius), foci)
