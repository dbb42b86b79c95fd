"""What comes before any wave: a few layouts chosen with care, one by one, where the score has a closed form."""

from collections.abc import Iterator

import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.problem import Problem
from multilens.question import Question
from multilens.search.foci import Foci
from multilens.search.limits import Limits
from multilens.search.packed import packed
from multilens.search.sketch import sketch
from multilens.search.tighten import tighten
from multilens.search.variables import Variables

MOST_LENSES = 16
"""Up to which crowded lenses are packed: of more a wave says more in the time."""

ROUNDING = 1e-10
"""Part of the back's diagonal by which an aperture may be below its largest and count as that."""


def first_layouts(
    question: Question,
    variables: Variables,
    foci: Foci,
    limits: Limits,
    tried: tuple[Float[Tensor, "p 2"], Float[Tensor, " p"]],
    generator: Generator,
    deadline: float,
) -> Iterator[tuple[Float[Tensor, " v"], bool]]:
    """Yield the sketch, if it is feasible, and unless all its apertures are as wide as can be what is good of some packings.

    Args:
        question: what is asked.
        variables: in float64.
        foci: chooses foci.
        limits: exact ones.
        tried: places where lenses may stand, mm, and the body radius that fits around each, mm.
        generator: of random numbers, on the processor.
        deadline: by the monotonic clock, s.

    Yields:
        Vectors, every unknown, and whether each is worth a polish to the end. None where a lens has a place of its own or the
        score has no closed form.

    Raises:
        OutOfTimeError: the deadline passed.
    """
    if not isinstance(question, Problem) or not question.has_closed_form:
        return
    if any(lens.position is not None for lens in question.lenses):
        return
    drawn, begun = sketch(question, *tried), torch.empty(0, len(variables.low), dtype=torch.float64)
    crowded = len(question.lenses) <= MOST_LENSES and len(question.depths.unique()) > 1
    if drawn is not None:
        fitted = tighten(limits, drawn)
        crowded &= bool((drawn.aperture_radius - fitted.aperture_radius).max() > ROUNDING * question.back.size)
        share = variables.spread(variables.vector(fitted))
        if crowded and limits(fitted).least >= 0:
            begun = share.unsqueeze(0)
        elif limits(fitted).least >= 0:
            yield foci.dealt(share), True
    if crowded:
        yield from packed(question, variables, foci, tried, begun, generator, deadline)
