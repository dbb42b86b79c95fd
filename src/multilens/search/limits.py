"""The constraints as a search wants them: room and direction for each pair of lenses and for each edge that a lens may touch."""

from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from multilens.geometry.distance import is_crossed, outward_normals
from multilens.geometry.pairs import pair_indices
from multilens.layout import Layout
from multilens.problem import Question

TINY = 1e-300


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
        device: where to compute.
    """

    def __init__(self, question: Question, device: str | torch.device = "cpu") -> None:
        self.question = question
        back = question.back
        self.no_limit = back.size
        """mm; room that stands for an edge that limits nothing from where the lens is."""
        sides = [(back.outline, True, 0.0)] + [(keep.shape, False, -keep.clearance) for keep in back.keep_outs]
        edges = [torch.from_numpy(shape.segments) for shape, _, _ in sides]
        counts = torch.tensor([len(e) for e in edges], dtype=torch.long)
        kind = {"dtype": torch.float64, "device": device}
        self.edges = torch.cat(edges).to(device)
        self.owner = torch.arange(len(sides)).repeat_interleave(counts).to(device)
        within = torch.tensor([within for _, within, _ in sides], dtype=torch.bool, device=device)
        reach = [reach + (shape.radius if within else -shape.radius) for shape, within, reach in sides]
        self.reach = torch.tensor(reach, **kind)[self.owner]
        self.start, self.along = self.edges[:, 0], self.edges[:, 1] - self.edges[:, 0]
        length_squared = self.along.square().sum(-1, keepdim=True)
        self.along_share = self.along / length_squared.where(length_squared > 0, 1)
        # A point or a line has no inside: lenses that stay within its reach are on the way out wherever they are.
        flat = torch.tensor([shape.core.area == 0 for shape, _, _ in sides], dtype=torch.bool, device=device)
        self.sign = torch.where(flat & within, -1.0, 1.0).to(**kind)[self.owner]
        self.rings = (~flat[self.owner]).nonzero().flatten()
        self.ring_owner = torch.nn.functional.one_hot(self.owner[self.rings], len(sides)).to(**kind)
        self.ring_within = within & ~flat
        # The way to go from right on an edge, where a lens off the back is held by its bounds: inward, or away from a keep-out.
        side = torch.where(within[self.owner], -1.0, 1.0).to(self.edges)
        self.inward = side.unsqueeze(-1) * outward_normals(self.edges)
        self.first, self.second = pair_indices(len(question.lenses), device)
        self.clearance = torch.tensor([lens.clearance for lens in question.lenses], **kind)
        self.least_apart = self.clearance[self.first] + self.clearance[self.second] + question.gap

    def __call__(self, layout: Layout) -> Room:
        """Give the room left at every limit, in float64."""
        position, radius = layout.position.double(), layout.aperture_radius.double()
        away = position[..., self.first, :] - position[..., self.second, :]
        distance = away.norm(dim=-1)
        apart = distance - (radius[..., self.first] + radius[..., self.second] + self.least_apart)
        parting = away / distance.clamp(min=TINY).unsqueeze(-1)
        room, inward = self._at_edges(position)
        return Room(apart, parting, room - (radius + self.clearance).unsqueeze(-1), inward)

    def _at_edges(self, position: Float[Tensor, "*batch n 2"]) -> tuple[Tensor, Tensor]:
        from_start = position.unsqueeze(-2) - self.start
        share = (from_start * self.along_share).sum(-1).clamp_(0, 1)
        offset = from_start - share.unsqueeze(-1) * self.along
        distance = offset.norm(dim=-1)
        sign, no_limit = self.sign, None
        if len(self.rings):
            wrong_side = self._on_the_wrong_side(position)
            if wrong_side.any():
                sign, no_limit = self._back_by_the_nearest(distance, wrong_side)
        room = sign * distance + self.reach
        inward = (sign / distance.clamp(min=TINY)).unsqueeze(-1) * offset
        if no_limit is not None:
            room = room.masked_fill(no_limit, self.no_limit)
        on_edge = distance == 0
        if on_edge.any():
            inward = torch.where(on_edge.unsqueeze(-1), self.inward, inward)
        return room, inward

    def _on_the_wrong_side(self, position: Tensor) -> Bool[Tensor, "*batch n s"]:
        crossed = is_crossed(position, self.edges[self.rings]).to(position.dtype)
        inside = (crossed @ self.ring_owner).remainder(2) > 0.5
        return inside != self.ring_within

    def _back_by_the_nearest(self, distance: Tensor, wrong_side: Tensor) -> tuple[Tensor, Tensor]:
        """Give the signs, and the edges that do not count.

        On the wrong side of a shape only its nearest edge counts: that is where the lens has to go back.
        """
        shapes = wrong_side.shape[-1]
        owner = self.owner.expand_as(distance)
        least = distance.new_full((*distance.shape[:-1], shapes), torch.inf).scatter_reduce(-1, owner, distance, "amin")
        wrong, nearest = wrong_side[..., self.owner], distance == least[..., self.owner]
        return torch.where(wrong & nearest, -1.0, self.sign), wrong & ~nearest
