"""Foci out of a rut: each in turn takes the best of many values while everything else stays."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.problem import Question
from multilens.search.variables import Variables

VALUES = 192
"""Tried for each focus, by equal factors over its range; finer than the band of depths in which one lens can win."""

SWEEPS = 8
"""Through all foci, at most; two or three are enough as a rule."""


def refocus(question: Question, variables: Variables, x: Float[Tensor, " d"]) -> Float[Tensor, " d"]:
    """Improve the foci of one vector by trying values for one at a time, until a whole sweep changes nothing.

    A gradient moves a focus only as far as the next lens' band of depths. Here it can jump over it. The score never gets worse.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
        x: one vector.

    Returns:
        The vector with other foci.
    """
    foci = (variables.free >= variables.focus_start).nonzero().flatten().tolist()
    values = torch.linspace(0, 1, VALUES).to(x)
    score = question.terms(variables.layout(x)).amax()
    for _ in range(SWEEPS):
        before = score
        for element in foci:
            tried = x.repeat(VALUES, 1)
            tried[:, element] = values
            scores = question.terms(variables.layout(tried)).amax(-1)
            best = scores.argmin()
            if scores[best] < score:
                x, score = tried[best], scores[best]
        if not score < before:
            break
    return x
