"""Where the search begins: many layouts spread evenly over all that the question allows."""

from functools import lru_cache

import torch
from jaxtyping import Float
from torch import Tensor
from torch.quasirandom import SobolEngine

from multilens.back import Back
from multilens.constraints import room_at
from multilens.layout import Layout
from multilens.question import Question
from multilens.search.variables import Variables

PLACES_TRIED = 4096
"""Spread over the bounding box; a back that fills a tenth of it leaves about 400 to choose from."""


def scattered_starts(
    question: Question, variables: Variables, count: int, seed: int, first: int = 0
) -> Float[Tensor, "count d"]:
    """Give vectors from a scrambled Sobol sequence, every lens that is free to go anywhere where its smallest body fits.

    A longer list begins with a shorter one of the same seed: what start i is does not depend on how many there are.

    Args:
        question: gives the back and the bodies.
        variables: says which unknowns are free.
        count: how many starts, >= 1.
        seed: of the scrambling.
        first: how many starts of the sequence to leave out, >= 0.

    Returns:
        Vectors, in the variables' own units.
    """
    draws = _sobol(len(variables) + len(question.lenses), count, seed, first).to(variables.upper)
    layout = variables.layout(draws[:, : len(variables)] * variables.upper)
    position = layout.position.clone()
    tried, room = tried_places(question.back, seed)
    for index, lens in enumerate(question.lenses):
        places = tried[room >= lens.least_body_radius]
        if lens.position is None and len(places):
            chosen = (draws[:, len(variables) + index] * len(places)).long().clamp(max=len(places) - 1)
            position[:, index] = places.to(position)[chosen]
    return variables.vector(Layout(position, layout.aperture_radius, layout.focus))


@lru_cache(maxsize=4)
def tried_places(back: Back, seed: int) -> tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]]:
    """Give points spread evenly over the back's bounding box, in no order, and the body radius that fits around each, mm."""
    left, top, right, bottom = back.outline.bounds
    corner = torch.tensor([left, top], dtype=torch.float64)
    size = torch.tensor([right - left, bottom - top], dtype=torch.float64)
    tried = corner + _sobol(2, PLACES_TRIED, seed) * size
    return tried, torch.from_numpy(room_at(back, tried[:, 0].numpy(), tried[:, 1].numpy()))


def _sobol(dimensions: int, count: int, seed: int, first: int = 0) -> Float[Tensor, "count d"]:
    return SobolEngine(dimensions, scramble=True, seed=seed).fast_forward(first).draw(count, dtype=torch.float64)
