"""The constraints as a search wants them: room and direction for each pair of lenses and for each edge that a lens may touch."""

from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.constraints import body_radius, pair_room
from multilens.geometry.distance import is_crossed, offset_from_segments, outward_normals
from multilens.geometry.pairs import pair_indices
from multilens.geometry.simplify import few_edges
from multilens.layout import Layout
from multilens.problem import Question

COARSE = 2e-4
"""Part of the back's diagonal by which outlines of many edges are made smaller to have few."""


@dataclass(frozen=True)
class Room:
    """What is left at every limit, and which way it grows.

    Args:
        apart: between the bodies of each pair, less the gap, mm, negative where they overlap.
        parting: unit vector along which the first of the pair moves away; the second's is the opposite.
        inside: of each lens at each edge, mm, negative where it is crossed.
        inward: unit vector along which the lens moves away from that edge.
    """

    apart: Float[Tensor, "*batch p"]
    parting: Float[Tensor, "*batch p 2"]
    inside: Float[Tensor, "*batch n e"]
    inward: Float[Tensor, "*batch n e 2"]

    @property
    def least(self) -> Float[Tensor, "*batch"]:
        """The least room, mm: a layout is feasible where it is not negative."""
        inside = self.inside.amin((-2, -1))
        return torch.minimum(inside, self.apart.amin(-1)) if self.apart.shape[-1] else inside


class Limits:
    """The room that is left at each pair of lenses and at each edge of the back.

    A corner of the back limits a lens by two edges at once. The least distance alone would have a kink there, just where the
    best layouts are; the edges one by one have none.

    Args:
        question: whose lenses and back are taken.
        coarse: cut round corners of the outline into edges and give rims of many edges few, on the safe side: then a step costs
            the same for any outline, and an edge's room changes smoothly where lenses are on the back.
        device: where to compute.
    """

    def __init__(self, question: Question, coarse: bool = False, device: str | torch.device = "cpu") -> None:
        self.question = question
        back = question.back
        self.no_limit = back.size
        """mm; room that stands for an edge that limits nothing from where the lens is."""
        sides = [(back.outline, True, 0.0)] + [(keep.shape, False, -keep.clearance) for keep in back.keep_outs]
        if coarse:
            tolerance = COARSE * back.size
            sides = [(few_edges(shape, within, tolerance), within, reach) for shape, within, reach in sides]
        edges = [torch.from_numpy(shape.segments) for shape, _, _ in sides]
        self.edges = torch.cat(edges).to(device)
        self.edges_of_shape = [len(e) for e in edges]
        owner = torch.arange(len(sides)).repeat_interleave(torch.tensor(self.edges_of_shape, dtype=torch.long))
        self.owner = owner.to(device)
        self.within = torch.tensor([within for _, within, _ in sides], dtype=torch.bool, device=device)
        reach = [reach + (shape.radius if within else -shape.radius) for shape, within, reach in sides]
        self.reach = torch.tensor(reach, dtype=torch.float64, device=device)[self.owner]
        # The way to go from right on an edge, where a lens off the back is held by its bounds: inward, or away from a keep-out.
        side = torch.where(self.within[self.owner], -1.0, 1.0).to(self.edges)
        self.inward = side.unsqueeze(-1) * outward_normals(self.edges)

    def __call__(self, layout: Layout) -> Room:
        """Give the room left at every limit."""
        position = layout.position
        first, second = pair_indices(layout.count, position.device)
        away = position[..., first, :] - position[..., second, :]
        tiny = torch.finfo(away.dtype).tiny
        parting = away / away.norm(dim=-1, keepdim=True).clamp(min=tiny)
        room, inward = self._at_edges(position)
        room = room - body_radius(layout, self.question.lenses).unsqueeze(-1)
        return Room(pair_room(layout, self.question.lenses, self.question.gap), parting, room, inward)

    def _at_edges(self, position: Float[Tensor, "*batch n 2"]) -> tuple[Tensor, Tensor]:
        edges, reach = self.edges.to(position.dtype), self.reach.to(position.dtype)
        offset = offset_from_segments(position, edges)
        distance = offset.norm(dim=-1)
        crossed = is_crossed(position, edges).split(self.edges_of_shape, dim=-1)
        inside = torch.stack([each.sum(-1).remainder(2).bool() for each in crossed], dim=-1)
        right_side = (inside == self.within)[..., self.owner]
        # On the wrong side of a shape only its nearest edge counts: that is where the lens has to go back.
        least = torch.stack([each.amin(-1) for each in distance.split(self.edges_of_shape, dim=-1)], dim=-1)
        nearest = distance == least[..., self.owner]
        sign = torch.where(right_side, 1.0, torch.where(nearest, -1.0, 0.0)).to(distance)
        room = torch.where(sign != 0, sign * distance + reach, self.no_limit)
        inward = (sign / distance.clamp(min=torch.finfo(distance.dtype).tiny)).unsqueeze(-1) * offset
        return room, torch.where((distance == 0).unsqueeze(-1), self.inward.to(distance.dtype), inward)
