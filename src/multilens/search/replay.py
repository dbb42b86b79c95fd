"""Fresh starts settled once more, step by step, for whoever wants to watch; a search itself keeps nothing of its way."""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from scipy.optimize import linear_sum_assignment
from torch import Tensor

from multilens.layout import Layout
from multilens.penalty import distance_penalty
from multilens.question import Question
from multilens.search.barrier import BarrierSettings, settle
from multilens.search.foci import Foci
from multilens.search.parting import part
from multilens.search.rough import at_few_depths
from multilens.search.sight import Seer, Sight
from multilens.search.solve import BATCH, FROM_AFAR, LAST, STEPS, STEPS_PER_LENS
from multilens.search.starts import scattered_starts
from multilens.search.threads import one_thread
from multilens.search.variables import Variables


@dataclass(frozen=True, eq=False)
class Replay:
    """How fresh starts came to rest.

    Args:
        layouts: a batch, of every start at every step.
        scores: of each, as the question scores it; not finite where it cannot.
        chosen: the start that ends best.
    """

    layouts: Layout
    scores: Float[Tensor, "s h"]
    chosen: int


def replay(question: Question, found: Layout, starts: int = BATCH, seed: int = 0) -> Replay:
    """Settle the first fresh starts of a search as it does, and keep every step of their way.

    Args:
        question: what is asked.
        found: what the search found. Lenses that are alike are numbered so that those of the best start end near these.
        starts: how many, from 1 to 64.
        seed: of the search.

    Raises:
        ValueError: starts is out of its range.
    """
    if not 1 <= starts <= BATCH:
        raise ValueError(f"starts must be from 1 to {BATCH}, got {starts}")
    seen: list[Sight] = []
    variables, rough = Variables(question), at_few_depths(question)
    with one_thread():
        share = variables.spread(scattered_starts(question, variables, starts, seed))
        share[:, 2 * variables.count : variables.focus_start] *= 0.5
        share = part(variables, distance_penalty(question), share)
        share = Foci(rough, variables, torch.Generator().manual_seed(seed)).afresh(share)
        steps = BarrierSettings(STEPS + STEPS_PER_LENS * variables.count, (FROM_AFAR, LAST))
        settled = settle(Seer(rough, variables), share, steps, watch=seen.append)
        layouts = variables.layout_of(torch.stack([sight.share for sight in seen], dim=1))
        scores = question.score(layouts)
    chosen = int(torch.where(settled.feasible, settled.value, torch.inf).argmin())
    return Replay(layouts.only(_order(question, layouts[chosen][-1], found)), scores, chosen)


def _order(question: Question, layout: Layout, found: Layout) -> list[int]:
    """Give for each lens of what was found the lens of a layout that stands for it: a like one, all together the nearest."""
    apart = torch.cdist(found.position, layout.position).numpy()
    unlike = [[one != other for other in question.lenses] for one in question.lenses]
    return linear_sum_assignment(apart + question.back.size * len(apart) * np.array(unlike))[1].tolist()
