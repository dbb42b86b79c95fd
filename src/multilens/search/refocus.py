"""Foci out of a rut: each in turn takes the best of many values while everything else stays."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.cues import LensDefocus, LimitedStereo, PairStereo, PhotometricDefocus, PhotometricStereo
from multilens.problem import Problem
from multilens.question import Question
from multilens.search.variables import Variables

VALUES = 64
"""Tried for each focus, by equal factors over its range."""

FEW_VALUES = 32
"""The same where every cue is one of BROAD."""

BROAD = (PairStereo, LimitedStereo, PhotometricStereo, PhotometricDefocus)
"""Cues without the narrow bands of the thesis' defocus: a texture fades over a wide range of depths."""

SWEEPS = 2
"""Through all foci; more change little, and the next wave comes anyway."""

FEW_AT_ONCE = 8
"""Layouts whose trials, a number for each value and depth, stay in the processor's cache."""

MOST_AT_ONCE = 4096
"""Layouts tried together where every cue has to be asked."""

ROUNDING = 1e-6
"""Part of a score in single precision."""


def refocus(
    question: Question,
    variables: Variables,
    share: Float[Tensor, "b v"],
    order: Float[Tensor, " f"],
    afresh: bool = False,
) -> Float[Tensor, "b v"]:
    """Improve the foci of each layout by trying values for one at a time.

    A gradient moves a focus only as far as the next lens' band of depths. Here it can jump over it. The score never gets
    worse, unless afresh.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
        share: the layouts, every unknown.
        order: one number for each focus; those of less come first.
        afresh: begin as if no lens were focused anywhere, so that each takes the best of what the ones before it left.
    """
    foci = [f for f in order.argsort().tolist() if variables.free.eq(variables.focus_start + f).any()]
    if not foci:
        return share
    if isinstance(question, Problem) and question.is_envelope:
        few = share.split(FEW_AT_ONCE)
        return torch.cat([_by_lines(question, variables, layouts, foci, afresh) for layouts in few])
    for element in (variables.focus_start + f for _ in range(SWEEPS) for f in foci):
        share = _one_by_one(question, variables, share, element)
    return share


def _one_by_one(question: Question, variables: Variables, share: Tensor, element: int) -> Tensor:
    """Try every value of one focus by asking the question for each."""
    # Single precision is plenty to choose between values; a score of one's own may not be made for it.
    kind = torch.float32 if isinstance(question, Problem) else share.dtype
    values = torch.linspace(0, 1, _how_many(question)).to(share)
    best = []
    with torch.no_grad():
        for layouts in share.split(max(1, MOST_AT_ONCE // len(values))):
            tried = layouts.unsqueeze(1).repeat(1, len(values) + 1, 1)
            tried[:, :-1, element] = values
            scores = question.terms(variables.layout_of(tried).to(kind)).amax(-1).nan_to_num(nan=torch.inf)
            # What is there stays unless another is better by more than roundings.
            scores[:, -1] -= ROUNDING * scores[:, -1].abs()
            best.append(tried[torch.arange(len(tried)), scores.argmin(-1)])
    return torch.cat(best)


def _how_many(question: Question) -> int:
    broad = isinstance(question, Problem) and all(isinstance(cue, BROAD) for cue in question.cues)
    return FEW_VALUES if broad else VALUES


def _by_lines(problem: Problem, variables: Variables, share: Tensor, foci: list[int], afresh: bool) -> Tensor:
    """Try every value of one focus against the envelope of all other cues, divided by the depth."""
    defocus = next((cue for cue in problem.cues if isinstance(cue, LensDefocus)), None)
    if defocus is None:
        return share
    layout = variables.layout_of(share)
    # Measurements of defocus are in the order of the foci: lens by lens, tier by tier.
    slope, zf = defocus.slope_and_focus(layout, problem.lenses)
    # Single precision, with lengths of about 1, is plenty to choose between values.
    kind = torch.float32
    depths, weights = problem.depths.to(share), problem.score_weights.to(share)
    unit = depths.max()
    line, weight = (depths / unit).to(kind), (weights * (depths / unit).square()).to(kind)
    steep = slope.amax(-1, keepdim=True)
    slope = (slope / steep).to(kind)
    stereo = line.new_full((len(share), len(depths)), 1e15)
    for cue in problem.cues:
        if isinstance(cue, PairStereo) and len(problem.lenses) > 1:
            stereo = (cue.gain(layout, problem.lenses).amin(-1, keepdim=True) / steep).to(kind) * line
    curves = slope.unsqueeze(-1) * (line - (zf / unit).to(kind).unsqueeze(-1)).abs()
    if afresh:
        curves[:, foci] = 1e15

    def summed(squares: Tensor) -> Tensor:
        return squares @ weight if problem.metric.is_mean else squares.mul_(weight).amax(-1)

    share = share.clone()
    values = torch.linspace(0, 1, VALUES).to(share)
    near, far = variables.low[variables.focus_start :], variables.high[variables.focus_start :]
    for sweep in range(SWEEPS):
        for focus in foci:
            others = stereo.clone()
            for other in range(curves.shape[1]):
                if other != focus:
                    torch.minimum(others, curves[:, other], out=others)
            tried = (near[focus] * (far[focus] / near[focus]) ** values / unit).to(kind)
            shapes = (line - tried.unsqueeze(-1)).abs()
            least = torch.minimum(others.unsqueeze(1), slope[:, focus, None, None] * shapes)
            best, at = summed(least.square_()).min(-1)
            now = summed(torch.minimum(others, curves[:, focus]).square())
            better = (best < now * (1 - ROUNDING)) | (afresh and sweep == 0)
            element = variables.focus_start + focus
            share[:, element] = torch.where(better, values[at], share[:, element])
            curves[:, focus] = torch.where(better.unsqueeze(-1), slope[:, focus, None] * shapes[at], curves[:, focus])
    return share
