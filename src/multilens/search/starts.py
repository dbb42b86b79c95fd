"""Where the search begins: many layouts spread evenly over all that the question allows."""

from math import pi

import torch
from jaxtyping import Float
from torch import Tensor
from torch.quasirandom import SobolEngine

from multilens.back import Back
from multilens.constraints import room_at
from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.problem import Question
from multilens.search.variables import Variables

AT_ONCE = 256
"""Layouts for which all places are looked through together; all at once would ask for memory without end."""

PLACES_TRIED = 4096
"""Spread over the bounding box; a back that fills a tenth of it leaves about 400 to choose from."""


def scattered_starts(
    question: Question, variables: Variables, count: int, seed: int, first: int = 0
) -> Float[Tensor, "count d"]:
    """Give vectors from a scrambled Sobol sequence, every lens that is free to go anywhere where its smallest body fits.

    In every second one, the second, the fourth and so on, two lenses stand as far apart as the back allows in some direction.

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
    draws = _sobol(len(variables) + len(question.lenses) + 2, count, seed, first).to(variables.upper)
    layout = variables.layout(draws[:, : len(variables)] * variables.upper)
    position = layout.position.clone()
    tried, room = tried_places(question.back, seed)
    for index, lens in enumerate(question.lenses):
        places = tried[room >= lens.least_body_radius]
        if lens.position is None and len(places):
            chosen = (draws[:, len(variables) + index] * len(places)).long().clamp(max=len(places) - 1)
            position[:, index] = places.to(position)[chosen]
    second = slice((first + 1) % 2, None, 2)
    for some, drawn in zip(position[second].split(AT_ONCE), draws[second, -2:].split(AT_ONCE), strict=True):
        _part_two(question, some, drawn, tried.to(position), room.to(position))
    return variables.vector(Layout(position, layout.aperture_radius, layout.focus))


def _part_two(question: Question, position: Tensor, draws: Tensor, tried: Tensor, room: Tensor) -> None:
    """Move two lenses of each layout, in place, to the first and the last place along a direction; both are drawn."""
    free = torch.tensor([i for i, lens in enumerate(question.lenses) if lens.position is None], dtype=torch.long)
    if len(free) < 2 or not len(position):
        return
    pairs = free[pair_indices(len(free))]
    chosen = pairs[:, (draws[:, 0] * pairs.shape[1]).long().clamp(max=pairs.shape[1] - 1)]
    angle = pi * draws[:, 1:]
    along = torch.cat([angle.cos(), angle.sin()], dim=-1) @ tried.T
    body = torch.tensor([lens.least_body_radius for lens in question.lenses], dtype=room.dtype)
    layout = torch.arange(len(position))
    for lens, way in ((chosen[0], 1.0), (chosen[1], -1.0)):
        fits = room >= body[lens].unsqueeze(-1)
        place = tried[(way * along).masked_fill(~fits, -torch.inf).argmax(-1)]
        position[layout, lens] = place.where(fits.any(-1, keepdim=True), position[layout, lens])


def tried_places(back: Back, seed: int) -> tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]]:
    """Give points spread evenly over the back's bounding box, in no order, and the body radius that fits around each, mm."""
    left, top, right, bottom = back.outline.bounds
    corner = torch.tensor([left, top], dtype=torch.float64)
    size = torch.tensor([right - left, bottom - top], dtype=torch.float64)
    tried = corner + _sobol(2, PLACES_TRIED, seed) * size
    return tried, torch.from_numpy(room_at(back, tried[:, 0].numpy(), tried[:, 1].numpy()))


def _sobol(dimensions: int, count: int, seed: int, first: int = 0) -> Float[Tensor, "count d"]:
    return SobolEngine(dimensions, scramble=True, seed=seed).fast_forward(first).draw(count, dtype=torch.float64)
