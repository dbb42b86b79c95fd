"""What comes before any wave: a few layouts chosen with care, one by one, where the score has a closed form."""

from collections.abc import Iterator
from math import inf

from jaxtyping import Float
from torch import Generator, Tensor

from multilens.problem import Problem
from multilens.question import Question
from multilens.search.foci import Foci
from multilens.search.limits import Limits
from multilens.search.packings import packings
from multilens.search.polish import polish
from multilens.search.sketch import sketch
from multilens.search.tighten import tighten
from multilens.search.variables import Variables

PACKED, TRIES = 16, 2
"""Packings of a round, and those of them that are polished."""

ROUNDS, MOST_LENSES = 4, 4
"""Of packings, and the lenses up to which there are any: of more lenses a wave says more in the time."""

ROUNDING = 1e-10
"""Part of the back's diagonal by which an aperture may be below its largest and count as that."""

ROUGH = 1e-5
"""Part of the score to which they are polished as if depths had no gaps."""


def first_layouts(
    question: Question,
    variables: Variables,
    foci: Foci,
    limits: Limits,
    tried: tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]],
    generator: Generator,
    deadline: float,
) -> Iterator[Float[Tensor, " v"]]:
    """Yield the sketch, if it is feasible, and unless all its apertures are as wide as can be what is better of some packings.

    Args:
        question: what is asked.
        variables: in float64.
        foci: chooses foci.
        limits: exact ones.
        tried: places where lenses may stand, mm, and the body radius that fits around each, mm.
        generator: of random numbers, on the processor.
        deadline: by the monotonic clock, s.

    Yields:
        Vectors, every unknown; none where a lens has a place of its own or the score has no closed form.

    Raises:
        OutOfTimeError: the deadline passed.
    """
    known = isinstance(question, Problem) and question.has_closed_form
    if not known or any(lens.position is not None for lens in question.lenses):
        return
    drawn, few = sketch(question, *tried), len(question.lenses) <= MOST_LENSES
    if drawn is not None:
        fitted = tighten(limits, drawn)
        spacious = (drawn.aperture_radius - fitted.aperture_radius).max() <= ROUNDING * question.back.size
        if (spacious or not few) and limits(fitted).least >= 0:
            yield foci.dealt(variables.spread(variables.vector(fitted)))
            if spacious:
                return
    if few:
        yield from _packed(question, variables, foci, tried, generator, deadline)


def _packed(
    question: Problem,
    variables: Variables,
    foci: Foci,
    tried: tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]],
    generator: Generator,
    deadline: float,
) -> Iterator[Float[Tensor, " v"]]:
    """Yield packings that promise most, polished as if depths had no gaps, and the best with foci dealt anew, each if better."""
    best, found = inf, None

    def is_better(share: Float[Tensor, " v"]) -> bool:
        nonlocal best, found
        score = question.score(variables.layout_of(share)).item()
        if score < best:
            best, found = score, share
            return True
        return False

    for _ in range(ROUNDS):
        packed = variables.spread(variables.vector(packings(question, *tried, PACKED, generator)))
        for share in foci.widest_nearest(packed[foci.promise(packed).argsort()[:TRIES]]):
            share = variables.spread(polish(question, variables, share[variables.free], deadline, ROUGH, gapless=True))
            if is_better(share):
                yield share
    if found is not None and is_better(share := foci.dealt(found)):
        yield share
