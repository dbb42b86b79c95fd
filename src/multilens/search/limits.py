"""The constraints as a polish wants them: one number and one gradient for each edge and pair that a lens may touch."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.constraints import body_radius, pair_room
from multilens.geometry.distance import is_inside, offset_from_segments
from multilens.geometry.pairs import pair_indices
from multilens.geometry.shape import Shape
from multilens.layout import Layout
from multilens.problem import Question
from multilens.search.variables import Variables

MOST_EDGES_WATCHED = 12
"""Of each shape, nearest first: a disc rarely touches more than three, and all of a polygon's would slow every step."""

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
        sides = [(back.outline, True, 0.0)]
        sides += [(keep_out.shape, False, keep_out.clearance) for keep_out in back.keep_outs]
        self.watched = [_Watched(shape, within, clearance, near.position) for shape, within, clearance in sides]

    def __call__(self, x: Float[Tensor, " d"]) -> tuple[Float[Tensor, " m"], Float[Tensor, "m d"]]:
        """Give the room left at every limit, mm, and its gradient in the free unknowns."""
        layout = self.variables.layout(x)
        n = layout.count
        lens = torch.arange(n)
        first, second = pair_indices(n)
        values = [pair_room(layout, self.question.lenses, self.question.gap)]
        away = layout.position[first] - layout.position[second]
        direction = away / away.norm(dim=-1, keepdim=True).clamp(min=torch.finfo(x.dtype).tiny)
        gradient = x.new_zeros(len(first), len(self.variables.low))
        row = torch.arange(len(first))
        for axis in (0, 1):
            gradient[row, 2 * first + axis] = direction[:, axis]
            gradient[row, 2 * second + axis] = -direction[:, axis]
        gradient[row, 2 * n + first] = gradient[row, 2 * n + second] = -1
        gradients = [gradient]
        radius = body_radius(layout, self.question.lenses)
        for watched in self.watched:
            room, direction = watched(layout.position)
            gradient = x.new_zeros(*room.shape, len(self.variables.low))
            for axis in (0, 1):
                gradient[lens, :, 2 * lens + axis] = direction[..., axis]
            gradient[lens, :, 2 * n + lens] = -1
            values.append((room - radius.unsqueeze(-1)).flatten())
            gradients.append(gradient.flatten(0, 1))
        # The constraints do not see the foci, so that every unknown they do see is linear in x.
        return torch.cat(values), torch.cat(gradients)[:, self.variables.free] * self.variables.span


class _Watched:
    """The edges of one shape that are nearest to each lens; the shape is to be stayed within, or clear of."""

    def __init__(self, shape: Shape, within: bool, clearance: float, position: Float[Tensor, "n 2"]) -> None:
        segments = torch.from_numpy(shape.segments)
        distance = offset_from_segments(position, segments).norm(dim=-1)
        nearest = distance.topk(min(MOST_EDGES_WATCHED, len(segments)), largest=False).indices
        self.all_segments, self.segments, self.within = segments, segments[nearest], within
        self.reach = shape.radius if within else -shape.radius - clearance

    def __call__(self, position: Float[Tensor, "n 2"]) -> tuple[Float[Tensor, "n e"], Float[Tensor, "n e 2"]]:
        offset = torch.cat([offset_from_segments(p[None], s) for p, s in zip(position, self.segments, strict=True)])
        distance = offset.norm(dim=-1)
        inside = is_inside(position, self.all_segments)
        right_side = (inside if self.within else ~inside).unsqueeze(-1)
        nearest = torch.nn.functional.one_hot(distance.argmin(-1), distance.shape[-1]).bool()
        # On the wrong side only the way to the nearest edge counts: that is where the lens has to go.
        sign = torch.where(right_side, 1.0, torch.where(nearest, -1.0, 0.0)).to(distance)
        room = torch.where(sign != 0, sign * distance + self.reach, NO_LIMIT)
        return room, sign.unsqueeze(-1) * offset / distance.unsqueeze(-1).clamp(min=torch.finfo(distance.dtype).tiny)
