"""Layouts that are like good ones in most and unlike them in something: how a search leaves one basin for the next."""

from collections.abc import Sequence

import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.search.variables import Variables

SHRUNKEN = 0.6
"""Part of its radius that a lens keeps when others are moved about it, so that there is room to do so."""

SHAKE = 0.05
"""Standard deviation of a shaken place, in units of the longer side of the back."""


class Varier:
    """Draws changed copies of layouts.

    Args:
        variables: how a vector becomes a layout.
        places: of the back where the smallest lens fits, mm.
        generator: of random numbers, on the processor.
    """

    def __init__(self, variables: Variables, places: Float[Tensor, "p 2"], generator: Generator) -> None:
        self.variables, self.generator = variables, generator
        low, high = (end.cpu().double() for end in (variables.low, variables.high))
        self.n, self.foci = variables.count, variables.focus_start
        corner, span = low[: 2 * self.n].view(-1, 2), (high - low)[: 2 * self.n].view(-1, 2)
        free = torch.zeros(len(low), dtype=torch.bool).index_fill(0, variables.free.cpu(), True)
        self.free = free
        self.movable = free[: 2 * self.n].view(-1, 2).all(-1).nonzero().flatten().tolist()
        self.places = [(places - corner[lens]) / span[lens] for lens in self.movable] if len(places) else []

    def __call__(self, parents: Float[Tensor, "e v"], count: int) -> Float[Tensor, "count v"]:
        """Give changed copies of layouts, the changes and the parents drawn at random.

        One lens goes to another place; two change places; all are shaken; two change their apertures and foci; or some foci
        are drawn anew. What is not free stays as it is.
        """
        chosen = parents[self._draw(len(parents), count)].cpu().double()
        children = chosen.clone()
        for child in children:
            place, radius, focus = child[: 2 * self.n].view(-1, 2), child[2 * self.n : self.foci], child[self.foci :]
            kind = int(self._draw(5))
            if kind == 0 and self.places:
                self._relocate(place, radius)
            elif kind == 1 and len(self.movable) > 1:
                first, second = self._two_of(self.movable)
                place[[first, second]] = place[[second, first]]
                radius[[first, second]] = radius[[first, second]].min()
            elif kind == 2:
                place += SHAKE * torch.randn(place.shape, generator=self.generator, dtype=place.dtype)
                radius *= SHRUNKEN
            elif kind == 3 and self.n > 1:
                first, second = self._two_of(range(self.n))
                for numbers in (radius, focus[: self.n]):
                    numbers[[first, second]] = numbers[[second, first]]
            else:
                anew = torch.rand(len(focus), generator=self.generator) < max(2 / len(focus), 0.3)
                focus[anew] = torch.rand(int(anew.sum()), generator=self.generator, dtype=focus.dtype)
        return torch.where(self.free, children, chosen).clamp(0, 1).to(parents)

    def _relocate(self, place: Tensor, radius: Tensor) -> None:
        which = int(self._draw(len(self.movable)))
        lens = self.movable[which]
        place[lens] = self.places[which][self._draw(len(self.places[which]))]
        radius *= SHRUNKEN
        radius[lens] = 0.05

    def _two_of(self, lenses: Sequence[int]) -> tuple[int, int]:
        first, second = torch.randperm(len(lenses), generator=self.generator)[:2].tolist()
        return lenses[first], lenses[second]

    def _draw(self, below: int, count: int | None = None) -> Tensor:
        return torch.randint(below, () if count is None else (count,), generator=self.generator)
