"""The question that waves are asked: where every depth costs time, the same one at few depths."""

from dataclasses import replace
from typing import overload

import torch

from multilens.problem import Problem
from multilens.question import Question
from multilens.robust import Robust

FEW = 64
"""Depths that show a wave where to go; the last polish and every claim have them all."""

FEW_DEVICES = 16
"""Devices that show it, of a question that is asked of many."""


@overload
def at_few_depths(question: Problem) -> Problem: ...
@overload
def at_few_depths(question: Question) -> Question: ...
def at_few_depths(question: Question) -> Question:
    """Give the question at some of its depths, both ends among them, each with the weight of those that it is nearest to in line.

    Of a question that is asked of many devices, few of them are asked. The closed form of the thesis' cues costs the same at any
    number of depths, and a score of one's own has none: they stay as they are. So does the worst case of these cues: a focus
    would hide between few depths.
    """
    if isinstance(question, Robust) and not question.drawn.has_closed_form:
        few = min(question.samples, FEW_DEVICES)
        return replace(question, problem=_at_few_depths(question.problem), samples=few)
    if not isinstance(question, Problem) or question.has_closed_form:
        return question
    return _at_few_depths(question)


def _at_few_depths(question: Problem) -> Problem:
    if len(question.depths) <= FEW or (question.is_envelope and not question.metric.is_mean):
        return question
    count = len(question.depths)
    chosen = torch.linspace(0, count - 1, FEW, dtype=torch.float64).round().long()
    nearest = torch.bucketize(torch.arange(count), (chosen[:-1] + chosen[1:]) // 2)
    depths, order = question.depths.sort()
    weights = torch.zeros(FEW, dtype=depths.dtype).index_add_(0, nearest, question.weights[order])
    return replace(question, depths=depths[chosen], weights=weights, guess=question.prior_error)
