"""A sketch: the layout that one would draw at once, lenses wide open, two of them as far apart as the back allows."""

from functools import cache
from itertools import combinations_with_replacement
from math import hypot, inf

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.question import Question


def sketch(question: Question, places: Float[Tensor, "p 2"], room: Float[Tensor, " p"]) -> Layout | None:
    """Give a layout with two lenses at the ends of the longest baseline and each of the others where most room is left.

    The error of stereo falls as the baseline grows, and that of defocus as apertures do. Where there is room for the widest
    apertures and for the longest baseline no layout has better ones, and only the foci are left to choose. Where there is less
    the bodies overlap. A lens by itself stands where most room is.

    Args:
        question: what is asked.
        places: tried for the lenses that do not end the baseline, mm.
        room: body radius that fits around each, mm.

    Returns:
        Apertures as wide as they may be, foci as far as they may be. None where a lens has a place of its own, the score is
        one's own, or of several lenses no two fit with their widest apertures.
    """
    if not isinstance(question, Problem) or any(lens.position is not None for lens in question.lenses):
        return None
    ends = _longest_baseline(question)
    if not ends and len(question.lenses) > 1:
        return None
    body = [_widest_body(lens) for lens in question.lenses]
    tried, left = places.numpy(), room.numpy()
    others = sorted(set(range(len(body))) - set(ends), key=lambda lens: -body[lens])
    for lens in (*ends, *others):
        ends.setdefault(lens, tried[left.argmax()])
        away = np.hypot(*(tried - ends[lens]).T)
        left = np.minimum(left, away - body[lens] - question.gap)
    position = torch.from_numpy(np.stack([ends[lens] for lens in range(len(body))]))
    radius = torch.tensor([lens.aperture_radius[1] for lens in question.lenses], dtype=torch.float64)
    far = torch.tensor([far for _, far in question.focus_range], dtype=torch.float64)
    tiers = max(lens.tiers for lens in question.lenses)
    return Layout(position, radius, far.unsqueeze(-1).repeat(1, tiers))


def _longest_baseline(problem: Problem) -> dict[int, np.ndarray]:
    """Give two lenses and their places so that the error of stereo is least; nothing where no two of them fit."""
    alike: dict[tuple[float, float], list[int]] = {}
    for index, lens in enumerate(problem.lenses):
        alike.setdefault((_widest_body(lens), lens.disparity_noise / lens.focal_length), []).append(index)
    corners_for = cache(problem.back.corners_for)
    least, ends = inf, {}
    for first, second in combinations_with_replacement(alike, 2):
        # Both bodies in line are no longer than the back's diagonal, or they do not fit.
        if 2 * (first[0] + second[0]) > problem.back.size or (first == second and len(alike[first]) < 2):
            continue
        mine, its = corners_for(first[0]), corners_for(second[0])
        if not len(mine) or not len(its):
            continue
        away = np.hypot(*(mine[:, None] - its).transpose(2, 0, 1))
        one, other = np.unravel_index(away.argmax(), away.shape)
        longest = away[one, other]
        if longest < first[0] + second[0] + problem.gap or hypot(first[1], second[1]) >= least * longest:
            continue
        least = hypot(first[1], second[1]) / longest
        ends = {alike[first][0]: mine[one], alike[second][-1]: its[other]}
    return ends


def _widest_body(lens: Lens) -> float:
    return lens.aperture_radius[1] + lens.clearance
