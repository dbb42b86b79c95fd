"""What an interior-point method sees of a question from where it stands: a value, its slope, and the limits with theirs."""

from dataclasses import dataclass
from math import isfinite

import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn.functional import pad

from multilens.geometry.pairs import pair_indices
from multilens.numerics import soft_maximum
from multilens.problem import Problem
from multilens.question import Question
from multilens.search.near_limits import NearLimits
from multilens.search.variables import Variables

LEAST_SCORE = 1e-300
"""mm^2; below it the logarithm of a score is not taken."""

SOFTNESS = 0.5
"""Width of the soft maximum of the logarithms of several squared errors. Of many depths now one is the worst, now another, and a
narrow maximum would see but one of them at a time; the polish makes it exact."""


@dataclass(frozen=True)
class Sight:
    """A batch of vectors and what is seen there; lengths of room are in units of `Seer.unit`.

    Args:
        share: where, every unknown from 0 to its upper end, free or not.
        value: what is minimised: the logarithm of the score, or a soft maximum of several terms or their logarithms.
        slope: its gradient, 0 for what is not free.
        room: left at every pair of lenses, then at every lens and edge.
        pull: gradient of a pair's room in (x, y, radius) of its first lens.
        push: the same in its second.
        edge: gradient of an edge's room in (x, y, radius) of its lens.
    """

    share: Float[Tensor, "b v"]
    value: Float[Tensor, " b"]
    slope: Float[Tensor, "b v"]
    room: Float[Tensor, "b m"]
    pull: Float[Tensor, "b p 3"]
    push: Float[Tensor, "b p 3"]
    edge: Float[Tensor, "b n e 3"]

    def where(self, chosen: Tensor, other: "Sight") -> "Sight":
        """Give this where chosen [b], the other elsewhere."""
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Sight(*(torch.where(chosen.view(-1, *[1] * (a.ndim - 1)), a, b) for a, b in pairs))


class Seer:
    """Looks at a question, and multiplies with the gradient of its limits, which touch few unknowns each.

    Args:
        question: what is asked.
        variables: in the type and on the device of the search.
    """

    def __init__(self, question: Question, variables: Variables) -> None:
        device = variables.low.device
        self.question, self.variables = question, variables
        self.limits = NearLimits(question, device)
        known = isinstance(question, Problem) and question.has_closed_form
        self.closed_form = question.closed_form(device) if isinstance(question, Problem) and known else None
        self.unit = question.back.size / 4
        """mm"""
        self.scale: float | None = None
        """Size of the terms; None while, or where, their logarithm is taken."""
        self.calibrated = False
        n = self.n = variables.count
        self.size = len(variables.low)
        self.first, self.second = pair_indices(n, device)
        lens = torch.arange(n, device=device)
        self.columns = torch.stack([2 * lens, 2 * lens + 1, 2 * n + lens], dim=-1)
        """Where x, y and radius of each lens stand in a vector."""
        self.free = torch.zeros(self.size, dtype=torch.bool, device=device).index_fill(0, variables.free, True)
        self.upper = torch.ones_like(variables.low).index_copy(0, variables.free, variables.upper)
        span = torch.where(self.free, variables.high - variables.low, 0) / self.unit
        self.span = span[self.columns]
        self.first_span, self.second_span = self.span[self.first], self.span[self.second]
        block = self.columns[:, None, :, None] * self.size + self.columns[None, :, None, :]
        self.entries = block.flatten()
        """Where each number of each lens' block with each lens stands in a flat matrix."""

    def calibrate(self, share: Float[Tensor, "b v"]) -> None:
        """Choose once what is minimised: the logarithm of squared errors, or terms in units of their size.

        Args:
            share: vectors whose terms are typical.
        """
        if self.calibrated:
            return
        with torch.no_grad():
            terms = self.question.terms(self.variables.layout_of(share))
        self.calibrated = True
        # A score of one's own may become negative on the way, whatever it is here.
        if self.question.metric is None or not (terms.amax(-1) > 0).all():
            scale = terms.abs().amax(-1).nanmedian().item()
            self.scale = scale if isfinite(scale) and scale > 0 else 1.0

    def look(self, share: Float[Tensor, "b v"], width: float) -> Sight:
        """Look at a batch of vectors.

        Args:
            share: where.
            width: of the soft maximum of several terms, in units of their size.
        """
        value, slope = self._value_and_slope(share, width)
        with torch.no_grad():
            room = self.limits(self.variables.layout_of(share))
            pull = pad(room.parting, (0, 1), value=-1.0)
            push = pad(-room.parting, (0, 1), value=-1.0)
            edge = pad(room.inward, (0, 1), value=-1.0)
            every = torch.cat([room.apart, room.inside.flatten(-2)], dim=-1) / self.unit
            limits = (every, pull * self.first_span, push * self.second_span, edge * self.span.unsqueeze(-2))
            # Room is told in double precision; the search goes on in its own.
            return Sight(share, value, slope, *(each.to(share.dtype) for each in limits))

    def _value_and_slope(self, share: Tensor, width: float) -> tuple[Float[Tensor, " b"], Float[Tensor, "b v"]]:
        if self.closed_form is not None and self.scale is None:
            with torch.no_grad():
                layout = self.variables.layout_of(share)
                score, slopes = self.closed_form(layout)
                score = score.clamp_(min=LEAST_SCORE)
                slope = self.variables.slope_of(layout, *slopes) / score.unsqueeze(-1)
                return score.log().to(share.dtype), slope.to(share.dtype)
        point = share.detach().requires_grad_()
        terms = self.question.terms(self.variables.layout_of(point))
        value = self._minimised(terms, width)
        (slope,) = torch.autograd.grad(value.sum(), point)
        return value.detach(), slope * self.free

    def _minimised(self, terms: Float[Tensor, "b m"], width: float) -> Float[Tensor, " b"]:
        if self.scale is not None:
            return soft_maximum(terms / self.scale, width)
        logarithm = terms.clamp(min=max(LEAST_SCORE, torch.finfo(terms.dtype).tiny)).log()
        return logarithm[..., 0] if terms.shape[-1] == 1 else soft_maximum(logarithm, SOFTNESS)

    def along(self, sight: Sight, step: Float[Tensor, "b v"]) -> Float[Tensor, "b m"]:
        """Give by how much each room grows along a step, to first order."""
        own = step[:, self.columns]
        pairs = (sight.pull * own[:, self.first] + sight.push * own[:, self.second]).sum(-1)
        return torch.cat([pairs, (sight.edge @ own.unsqueeze(-1)).flatten(1)], dim=-1)

    def gather(self, sight: Sight, force: Float[Tensor, "b m"]) -> Float[Tensor, "b v"]:
        """Give the sum over the limits of each one's gradient times a force."""
        pairs, edges = self._apart(sight, force)
        own = (edges.unsqueeze(-2) @ sight.edge).squeeze(-2)
        own = own.index_add(1, self.first, sight.pull * pairs.unsqueeze(-1))
        own = own.index_add(1, self.second, sight.push * pairs.unsqueeze(-1))
        return own.new_zeros(len(own), self.size).index_copy(1, self.columns.flatten(), own.flatten(1))

    def curvature(self, sight: Sight, stiffness: Float[Tensor, "b m"]) -> Float[Tensor, "b v v"]:
        """Give the sum over the limits of stiffness times the outer product of each one's gradient with itself."""
        pairs, edges = self._apart(sight, stiffness)
        batch, n = len(pairs), self.n
        pull, push = sight.pull * pairs.unsqueeze(-1), sight.push * pairs.unsqueeze(-1)
        blocks = pull.new_zeros(batch, n, n, 3, 3)
        mixed = pull.unsqueeze(-1) * sight.push.unsqueeze(-2)
        blocks[:, self.first, self.second] = mixed
        blocks[:, self.second, self.first] = mixed.transpose(-1, -2)
        own = (sight.edge * edges.unsqueeze(-1)).transpose(-1, -2) @ sight.edge
        own = own.index_add(1, self.first, pull.unsqueeze(-1) * sight.pull.unsqueeze(-2))
        own = own.index_add(1, self.second, push.unsqueeze(-1) * sight.push.unsqueeze(-2))
        lens = torch.arange(n, device=own.device)
        blocks[:, lens, lens] = own
        flat = blocks.new_zeros(batch, self.size**2).index_copy(1, self.entries, blocks.flatten(1))
        return flat.unflatten(-1, (self.size, self.size))

    def _apart(self, sight: Sight, every: Float[Tensor, "b m"]) -> tuple[Tensor, Tensor]:
        pairs = len(self.first)
        return every[:, :pairs], every[:, pairs:].view(sight.edge.shape[:-1])
