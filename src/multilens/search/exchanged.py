"""Two unlike lenses in each other's place: what tells the local optima of a few lenses apart more often than anything else."""

from itertools import combinations

import torch

from multilens.layout import Layout
from multilens.question import Question

ROUNDING = 1e-9
"""mm"""


def exchanged(question: Question, layout: Layout) -> Layout:
    """Give a layout with any two unlike lenses in each other's place, each as wide as the other's body lets it.

    Args:
        question: whose lenses are taken.
        layout: one, on the processor, in float64.

    Returns:
        A layout for each pair of unlike lenses whose smallest apertures fit in, with the foci as they are.
    """
    lenses = question.lenses
    pairs = [pair for pair in combinations(range(len(lenses)), 2) if lenses[pair[0]] != lenses[pair[1]]]
    place = torch.arange(len(lenses)).repeat(len(pairs), 1)
    for row, pair in zip(place, pairs, strict=True):
        row[list(pair)] = torch.tensor(pair[::-1], dtype=torch.long)
    low, high = torch.tensor([lens.aperture_radius for lens in lenses], dtype=torch.float64).T
    clearance = torch.tensor([lens.clearance for lens in lenses], dtype=torch.float64)
    room = (layout.aperture_radius + clearance)[place] - clearance
    # A lens that stays where it is may lack the last digit of its smallest aperture.
    fits = (room >= low - ROUNDING).all(-1)
    return Layout(
        layout.position[place[fits]],
        room[fits].maximum(low).minimum(high),
        layout.focus.expand(int(fits.sum()), *layout.focus.shape),
    )
