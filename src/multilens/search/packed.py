"""Where lenses crowd each other: of many packings those that promise most, focused and polished, before any wave."""

from collections.abc import Iterator
from math import inf

import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.problem import Problem
from multilens.search.foci import Foci
from multilens.search.packings import packings
from multilens.search.polish import polish
from multilens.search.promise import Promise
from multilens.search.variables import Variables

ROUNDS, PACKED, TRIES = 5, 64, 3
"""How many rounds, packings of each, and those of them that are polished."""

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
    best, seen = inf, []
    for _ in range(ROUNDS):
        new = variables.spread(variables.vector(packings(problem, *places, PACKED, generator)))
        own: list[tuple[float, Tensor]] = []
        for share in foci.widest_nearest(_most_promising(problem, variables, torch.cat([begun, new]))):
            x = polish(problem, variables, share[variables.free], deadline, ROUGH, gapless=True)
            own.append((_score(problem, variables, variables.spread(x)), variables.spread(x)))
            if own[-1][0] < best:
                best = own[-1][0]
                yield own[-1][1], False
        score, share = min(own, key=lambda each: each[0])
        if score < best * (1 + NEARLY) and all(abs(score / before - 1) > ALIKE for before in seen):
            share = foci.rearranged(share)
            best = min(best, _score(problem, variables, share))
            yield share, True
        seen.append(score)
        begun = begun[:0]


def _most_promising(problem: Problem, variables: Variables, share: Float[Tensor, "b v"]) -> Float[Tensor, "c v"]:
    gain, slope = problem.closed_form(share.device).gain_and_slope(variables.layout_of(share))
    promise = Promise(problem.depths.numpy(), problem.score_weights.numpy())
    return share[promise(gain.numpy(), (1 / slope).sum(-1).numpy()).argsort(kind="stable")[:TRIES]]


def _score(problem: Problem, variables: Variables, share: Float[Tensor, " v"]) -> float:
    return problem.score(variables.layout_of(share)).item()
