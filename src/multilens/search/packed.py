"""Where lenses crowd each other: of many packings those that promise most, focused and polished, before any wave."""

from collections.abc import Iterator
from itertools import islice
from math import inf

import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.problem import Problem
from multilens.search.exchanged import exchanged
from multilens.search.foci import Foci
from multilens.search.packings import packings
from multilens.search.polish import polish
from multilens.search.promise import Promise
from multilens.search.variables import Variables

ROUNDS, PACKED, TRIES = 5, 64, 3
"""How many rounds, packings of each, and those of them that are polished."""

EXCHANGES = 2
"""Layouts of each round, besides, in which two unlike lenses of the best so far are exchanged."""

ROUGH = 1e-5
"""Part of the score to which they are polished as if depths had no gaps."""

NEARLY = 5e-3
"""Part of the score by which the best of a round may be behind the best of all and yet be looked at again: gaps between the depths
and the order of the foci make as much."""

ALIKE = 2e-4
"""Part of it by which two are one."""


def packed(
    problem: Problem,
    variables: Variables,
    foci: Foci,
    places: tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]],
    begun: Float[Tensor, "b v"],
    generator: Generator,
    deadline: float,
) -> Iterator[tuple[Float[Tensor, " v"], bool]]:
    """Yield layouts, better and better, and after each round its best with its lenses in a better order along the depths.

    Args:
        problem: what is asked; its score has a closed form, and its depths are not all one.
        variables: in float64.
        foci: chooses foci.
        places: where lenses may stand, mm, and the body radius that fits around each, mm.
        begun: layouts that compete with the packings of the first round, every unknown.
        generator: of random numbers, on the processor.
        deadline: by the monotonic clock, s.

    Yields:
        Vectors, every unknown, and whether each is worth a polish to the end.

    Raises:
        OutOfTimeError: the deadline passed.
    """
    tries, best, seen = _Tries(problem, variables, foci, deadline), inf, []
    for _ in range(ROUNDS):
        new = variables.spread(variables.vector(packings(problem, *places, PACKED, generator)))
        own: list[tuple[float, Tensor]] = []
        for score, share in tries.round_of(torch.cat([begun, new])):
            own.append((score, share))
            if score < best:
                best = score
                yield share, False
        score, share = min(own, key=_score_of, default=(inf, begun))
        if score < best * (1 + NEARLY) and all(abs(score / before - 1) > ALIKE for before in seen):
            share = foci.rearranged(share)
            best = min(best, _score(problem, variables, share))
            yield share, True
        seen.append(score)
        begun = begun[:0]


class _Tries:
    """Polishes, as if depths had no gaps, what stands like nothing that was polished before."""

    def __init__(self, problem: Problem, variables: Variables, foci: Foci, deadline: float) -> None:
        self.problem, self.variables, self.foci, self.deadline = problem, variables, foci, deadline
        self.promise = Promise(problem.depths.numpy(), problem.score_weights.numpy())
        self.polished: list[tuple[float, Tensor]] = []

    def round_of(self, share: Float[Tensor, "b v"]) -> Iterator[tuple[float, Float[Tensor, " v"]]]:
        """Yield the score and the vector of the most promising, polished, and of the best of all with two lenses exchanged."""
        yield from self._best_of(share, TRIES)
        _, best = min(self.polished, key=_score_of)
        others = exchanged(self.problem, self.variables.layout_of(best))
        yield from self._best_of(self.variables.spread(self.variables.vector(others)), EXCHANGES)

    def _best_of(self, share: Float[Tensor, "b v"], most: int) -> Iterator[tuple[float, Float[Tensor, " v"]]]:
        new = (each for each in self._by_promise(share) if not self._is_known(each))
        for each in islice(new, most):
            x = self.foci.widest_nearest(each.unsqueeze(0))[0, self.variables.free]
            x = polish(self.problem, self.variables, x, self.deadline, ROUGH, gapless=True)
            found = self.variables.spread(x)
            self.polished.append((_score(self.problem, self.variables, found), found))
            yield self.polished[-1]

    def _by_promise(self, share: Float[Tensor, "b v"]) -> Float[Tensor, "b v"]:
        gain, slope = self.problem.closed_form(share.device).gain_and_slope(self.variables.layout_of(share))
        return share[self.promise(gain.numpy(), (1 / slope).sum(-1).numpy()).argsort(kind="stable")]

    def _is_known(self, share: Float[Tensor, " v"]) -> bool:
        """Give whether apertures that were polished hold the centres of the same lenses: a polish would lead there again."""
        if not self.polished:
            return False
        before = self.variables.layout_of(torch.stack([each for _, each in self.polished]))
        away = (self.variables.layout_of(share).position - before.position).norm(dim=-1)
        return bool((away < before.aperture_radius).all(-1).any())


def _score_of(found: tuple[float, Tensor]) -> float:
    return found[0]


def _score(problem: Problem, variables: Variables, share: Float[Tensor, " v"]) -> float:
    return problem.score(variables.layout_of(share)).item()
