"""The constraints as a polish wants them: one number and one gradient for each edge and pair that a lens may touch."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.constraints import body_radius, pair_room
from multilens.geometry.distance import is_crossed, offset_from_segments, outward_normals
from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.problem import Question
from multilens.search.variables import Variables

MOST_EDGES_WATCHED = 16
"""Around each lens, nearest first: a disc rarely touches more than three, and all of a polygon's would slow every step."""

NO_LIMIT = 1e6
"""mm; room that stands for an edge that limits nothing from where the lens is."""


class Limits:
    """The room that is left at each pair of lenses and at each edge near a lens, mm, and its gradient.

    A corner of the back limits a lens by two edges at once. The least distance alone would have a kink there, just where the
    best layouts are; the edges one by one have none.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
        near: the layout whose nearest edges are watched; farther ones are left out.
    """

    def __init__(self, question: Question, variables: Variables, near: Layout) -> None:
        self.question, self.variables = question, variables
        back = question.back
        sides = [(back.outline, True, back.outline.radius)]
        sides += [(keep.shape, False, -keep.shape.radius - keep.clearance) for keep in back.keep_outs]
        edges = [torch.from_numpy(shape.segments) for shape, _, _ in sides]
        self.edges = torch.cat(edges)
        owner = torch.repeat_interleave(
            torch.arange(len(sides)), torch.tensor([len(e) for e in edges], dtype=torch.long)
        )
        self.owner = torch.nn.functional.one_hot(owner, len(sides)).to(self.edges)
        self.within = torch.tensor([within for _, within, _ in sides], dtype=torch.bool)
        reach = torch.tensor([reach for _, _, reach in sides], dtype=torch.float64)
        far = offset_from_segments(near.position, self.edges).norm(dim=-1) + reach[owner]
        watched = far.topk(min(MOST_EDGES_WATCHED, len(self.edges)), largest=False).indices
        self.watched, self.watched_owner, self.reach = self.edges[watched], owner[watched], reach[owner[watched]]

    def __call__(self, x: Float[Tensor, " d"]) -> tuple[Float[Tensor, " m"], Float[Tensor, "m d"]]:
        """Give the room left at every limit, mm, and its gradient in the free unknowns."""
        layout = self.variables.layout(x)
        apart, apart_gradient = self._between_lenses(layout)
        left, left_gradient = self._on_the_back(layout)
        gradient = torch.cat([apart_gradient, left_gradient.flatten(0, 1)])
        # Positions and radii are linear in x, and no limit sees the foci.
        return torch.cat([apart, left.flatten()]), gradient[:, self.variables.free] * self.variables.span

    def _between_lenses(self, layout: Layout) -> tuple[Float[Tensor, " p"], Float[Tensor, "p v"]]:
        n = layout.count
        first, second = pair_indices(n)
        away = layout.position[first] - layout.position[second]
        direction = away / away.norm(dim=-1, keepdim=True).clamp(min=torch.finfo(away.dtype).tiny)
        gradient = away.new_zeros(len(first), len(self.variables.low))
        pair = torch.arange(len(first))
        for axis in (0, 1):
            gradient[pair, 2 * first + axis] = direction[:, axis]
            gradient[pair, 2 * second + axis] = -direction[:, axis]
        gradient[pair, 2 * n + first] = gradient[pair, 2 * n + second] = -1
        return pair_room(layout, self.question.lenses, self.question.gap), gradient

    def _on_the_back(self, layout: Layout) -> tuple[Float[Tensor, "n e"], Float[Tensor, "n e v"]]:
        position = layout.position
        offset = offset_from_segments(position, self.watched)
        distance = offset.norm(dim=-1)
        inside = (is_crossed(position, self.edges).to(self.owner) @ self.owner).remainder(2).bool()
        right_side = (inside == self.within).gather(-1, self.watched_owner)
        # On the wrong side of a shape only the way to its nearest edge counts: that is where the lens has to go.
        same_shape = self.watched_owner.unsqueeze(-1) == self.watched_owner.unsqueeze(-2)
        nearest_of_shape = torch.where(same_shape, distance.unsqueeze(-2), torch.inf).amin(-1)
        sign = torch.where(right_side, 1.0, torch.where(distance == nearest_of_shape, -1.0, 0.0)).to(distance)
        room = torch.where(sign != 0, sign * distance + self.reach, NO_LIMIT)
        direction = sign.unsqueeze(-1) * offset / distance.unsqueeze(-1).clamp(min=torch.finfo(distance.dtype).tiny)
        # Right on an edge, where bounds hold a lens to the side of a back, the offset no longer tells where to go.
        side = torch.where(self.within[self.watched_owner], -1.0, 1.0).to(distance).unsqueeze(-1)
        direction = torch.where((distance == 0).unsqueeze(-1), side * outward_normals(self.watched), direction)
        n, lens = layout.count, torch.arange(layout.count)
        gradient = position.new_zeros(*room.shape, len(self.variables.low))
        for axis in (0, 1):
            gradient[lens, :, 2 * lens + axis] = direction[..., axis]
        gradient[lens, :, 2 * n + lens] = -1
        return room - body_radius(layout, self.question.lenses).unsqueeze(-1), gradient
