"""The foci of a wave: shared out by dynamic programming or one by one, and a last look at those of the best."""

from functools import cached_property

import numpy as np
import torch
from jaxtyping import Float
from torch import Generator, Tensor

from multilens.cues import LensDefocus
from multilens.problem import Problem
from multilens.question import Question
from multilens.robust import as_drawn
from multilens.search.dealing import Dealing
from multilens.search.ordering import Ordering
from multilens.search.piercing import Piercing
from multilens.search.refocus import refocus
from multilens.search.stretches import Stretches
from multilens.search.variables import Variables

DEALT = 7
"""Ways to deal the shared-out foci to unequal lenses that are tried for the best layout, beside its own order."""


class Foci:
    """Chooses foci for layouts.

    Of a question that is asked of many devices, foci are tried on the one that is as drawn, which takes a fraction of the time;
    all of them decide what is kept.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
        generator: of random numbers, on the processor.
    """

    def __init__(self, question: Question, variables: Variables, generator: Generator) -> None:
        self.asked, self.question = question, as_drawn(question)
        self.variables, self.generator = variables, generator
        device = variables.low.device
        self.columns = variables.free[variables.free >= variables.focus_start]
        self.stretches: Stretches | Piercing | None = None
        self.dealing: Dealing | None = None
        if isinstance(drawn := self.question, Problem) and len(self.columns) and _is_shared_out(drawn):
            self.closed_form = drawn.closed_form(device)
            if drawn.metric.is_mean:
                self.dealing = Dealing(drawn.depths.numpy(), drawn.score_weights.numpy())
            kind = Stretches if drawn.metric.is_mean else Piercing
            self.stretches = kind(drawn.depths.to(device), drawn.score_weights.to(device))

    def afresh(self, share: Float[Tensor, "b v"]) -> Float[Tensor, "b v"]:
        """Give the layouts with foci that do not depend on those they have."""
        if self.stretches is None:
            return self._one_by_one(share, afresh=True)
        share = share.clone()
        # Shared out as if apertures were as wide as they may be: that is where most of them go.
        wide = share[::2].clone()
        radii = slice(2 * self.variables.count, self.variables.focus_start)
        wide[:, radii] = 1.0
        share[::2, self.columns] = self._shared_out(wide, self._any_order(len(wide)))[:, self.columns]
        if len(share) > 1:
            share[1::2] = self._one_by_one(share[1::2], afresh=True)
        return share

    def improved(self, share: Float[Tensor, "b v"]) -> Float[Tensor, "b v"]:
        """Give the layouts with better foci, every fourth of them with foci shared out anew."""
        if self.stretches is not None:
            before, share = share, share.clone()
            share[::4] = self._shared_out(share[::4], self._any_order(len(share[::4])))
        else:
            before = share
        better = self._one_by_one(share, afresh=False)
        return better if self.asked is self.question else self._agreed(before, better)

    def best_for(self, share: Float[Tensor, " v"]) -> Float[Tensor, " v"]:
        """Give one layout with the best foci of several ways to choose them; never worse than it was."""
        if self.stretches is None:
            return share
        own = share[self.columns].argsort().argsort().unsqueeze(0)
        orders = torch.cat([own, self._any_order(DEALT)])
        dealt = self._shared_out(share.expand(1 + DEALT, -1), orders)
        if self.dealing is not None:
            dealt = torch.cat([dealt, self.dealt(share).unsqueeze(0), self.rearranged(share).unsqueeze(0)])
        tried = torch.cat([share.unsqueeze(0), dealt, self._one_by_one(dealt, afresh=False)])
        with torch.no_grad():
            return tried[self._minimised(tried).argmin()]

    def widest_nearest(self, share: Float[Tensor, "b v"]) -> Float[Tensor, "b v"]:
        """Give the layouts with foci shared out, those of wider apertures nearer; as they are where none are shared out."""
        if self.stretches is None:
            return share
        _, slope = self.closed_form.gain_and_slope(self.variables.layout_of(share))
        return self._shared_out(share, slope[:, self.columns - self.variables.focus_start].argsort(-1).argsort(-1))

    def dealt(self, share: Float[Tensor, " v"]) -> Float[Tensor, " v"]:
        """Give one layout with the best foci for its apertures and its longest baseline; as it is where they cannot be told."""
        if self.dealing is None:
            return share
        gain, slope = self.closed_form.gain_and_slope(self.variables.layout_of(share))
        return self._with_foci(share, self.dealing.best_foci(gain.item(), _in_numpy(slope), *self._bounds()))

    def rearranged(self, share: Float[Tensor, " v"]) -> Float[Tensor, " v"]:
        """Give one layout with its lenses in a better order along the depths, and the best foci for that; never worse than it was.

        As many unlike lenses as there may be are told apart, which `dealt` does not.
        """
        if self.dealing is None or self.ordering is None:
            return share
        gain, slope = self.closed_form.gain_and_slope(self.variables.layout_of(share))
        slope, (near, far) = _in_numpy(slope), self._bounds()
        tip = near * (far / near) ** _in_numpy(share[self.variables.focus_start :])
        order = self.ordering.improved(gain.item(), slope, tip)
        after = self._with_foci(share, self.dealing.best_in_order(gain.item(), slope, near, far, order))
        return after if self._minimised(after) < self._minimised(share) else share

    @cached_property
    def ordering(self) -> Ordering | None:
        """Exchanges lenses along the depths; None where foci are not dealt or all depths are one."""
        problem = self.question
        if self.dealing is None or not isinstance(problem, Problem) or len(problem.depths.unique()) < 2:
            return None
        return Ordering(problem.depths.numpy(), problem.score_weights.numpy())

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        start = self.variables.focus_start
        return _in_numpy(self.variables.low[start:]), _in_numpy(self.variables.high[start:])

    def _with_foci(self, share: Tensor, foci: np.ndarray) -> Tensor:
        near, far = (end[self.variables.focus_start :] for end in (self.variables.low, self.variables.high))
        at = (torch.from_numpy(foci).to(near) / near).log() / (far / near).log()
        share = share.clone()
        share[self.columns] = at[self.columns - self.variables.focus_start].clamp(0, 1)
        return share

    def _agreed(self, before: Tensor, after: Tensor) -> Tensor:
        """Give of each layout what scores less by the question itself."""
        with torch.no_grad():
            better = self._minimised(after) < self._minimised(before)
        return torch.where(better.unsqueeze(-1), after, before)

    def _minimised(self, share: Tensor) -> Tensor:
        return self.asked.terms(self.variables.layout_of(share)).amax(-1).nan_to_num(nan=torch.inf)

    def _one_by_one(self, share: Tensor, afresh: bool) -> Tensor:
        order = torch.rand(len(self.variables.low) - self.variables.focus_start, generator=self.generator)
        return refocus(self.question, self.variables, share, order, afresh)

    def _any_order(self, count: int) -> Tensor:
        order = torch.rand(count, len(self.columns), generator=self.generator).argsort(-1)
        return order.to(self.columns.device)

    def _shared_out(self, share: Tensor, order: Tensor) -> Tensor:
        """Give the layouts with the best foci for as many apertures of their mean width, dealt out in an order."""
        assert self.stretches is not None
        layout = self.variables.layout_of(share)
        gain, slope = self.closed_form.gain_and_slope(layout)
        foci = self.stretches.best_foci(gain, 1 / (1 / slope).mean(-1), len(self.columns))
        near, far = self.variables.low[self.columns], self.variables.high[self.columns]
        at = (foci.gather(-1, order) / near).log() / (far / near).log()
        share = share.clone()
        share[:, self.columns] = at.clamp(0, 1).to(share.dtype)
        return share


def _is_shared_out(problem: Problem) -> bool:
    return problem.is_envelope and any(isinstance(cue, LensDefocus) for cue in problem.cues)


def _in_numpy(tensor: Tensor) -> np.ndarray:
    return tensor.detach().cpu().double().numpy()
