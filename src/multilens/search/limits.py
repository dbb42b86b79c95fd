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
"""Around each lens, those that leave it least: a disc rarely touches more than three, and all would slow every step."""

NO_LIMIT = 1e6
"""mm; room that stands for an edge that limits nothing from where the lens is."""


class Limits:
    """The room that is left at each pair of lenses and at each edge near a lens, mm, and its gradient.

    A corner of the back limits a lens by two edges at once. The least distance alone would have a kink there, just where the
    best layouts are; the edges one by one have none.

    Args:
        question: what is asked.
        variables: how a vector becomes a layout.
    """

    def __init__(self, question: Question, variables: Variables) -> None:
        self.question, self.variables = question, variables
        back = question.back
        sides = [(back.outline, True, back.outline.radius)]
        sides += [(keep.shape, False, -keep.shape.radius - keep.clearance) for keep in back.keep_outs]
        edges = [torch.from_numpy(shape.segments) for shape, _, _ in sides]
        self.edges = torch.cat(edges)
        self.edges_of_shape = [len(e) for e in edges]
        self.owner = torch.arange(len(sides)).repeat_interleave(torch.tensor(self.edges_of_shape, dtype=torch.long))
        self.within = torch.tensor([within for _, within, _ in sides], dtype=torch.bool)
        self.reach = torch.tensor([reach for _, _, reach in sides], dtype=torch.float64)[self.owner]
        # The way to go from right on an edge, where a lens off the back is held by its bounds: inward, or away from a keep-out.
        side = torch.where(self.within[self.owner], -1.0, 1.0).to(self.edges)
        self.inward = side.unsqueeze(-1) * outward_normals(self.edges)

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
        offset = offset_from_segments(position, self.edges)
        distance = offset.norm(dim=-1)
        crossed = is_crossed(position, self.edges).split(self.edges_of_shape, dim=-1)
        inside = torch.stack([edges.sum(-1).remainder(2).bool() for edges in crossed], dim=-1)
        right_side = (inside == self.within)[:, self.owner]
        # On the wrong side of a shape only the way to its nearest edge counts: that is where the lens has to go.
        least = torch.stack([edges.amin(-1) for edges in distance.split(self.edges_of_shape, dim=-1)], dim=-1)
        nearest = distance == least[:, self.owner]
        sign = torch.where(right_side, 1.0, torch.where(nearest, -1.0, 0.0)).to(distance)
        room = torch.where(sign != 0, sign * distance + self.reach, NO_LIMIT)
        direction = sign.unsqueeze(-1) * offset / distance.unsqueeze(-1).clamp(min=torch.finfo(distance.dtype).tiny)
        direction = torch.where((distance == 0).unsqueeze(-1), self.inward, direction)
        if len(self.edges) > MOST_EDGES_WATCHED:
            # In the order of the edges, so that a limit keeps its place from one step to the next.
            watched = room.topk(MOST_EDGES_WATCHED, largest=False).indices.sort(-1).values
            room = room.gather(-1, watched)
            direction = direction.gather(-2, watched.unsqueeze(-1).expand(-1, -1, 2))
        n, lens = layout.count, torch.arange(layout.count)
        gradient = position.new_zeros(*room.shape, len(self.variables.low))
        for axis in (0, 1):
            gradient[lens, :, 2 * lens + axis] = direction[..., axis]
        gradient[lens, :, 2 * n + lens] = -1
        return room - body_radius(layout, self.question.lenses).unsqueeze(-1), gradient
