"""The constraints, exactly: room and direction for each pair of lenses and for each edge that a lens may touch."""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from multilens.geometry.distance import outward_normals
from multilens.layout import Layout
from multilens.question import Question

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
    best layouts are; the edges one by one have none. In NumPy, which asks little for each of many small steps.

    Args:
        question: whose lenses and back are taken.
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        back = question.back
        self.no_limit = back.size
        """mm; room that stands for an edge that limits nothing from where the lens is."""
        sides = [(back.outline, True, 0.0)] + [(keep.shape, False, -keep.clearance) for keep in back.keep_outs]
        edges = np.concatenate([shape.segments for shape, _, _ in sides])
        counts = [len(shape.segments) for shape, _, _ in sides]
        self.owner = np.repeat(np.arange(len(sides)), counts)
        self.first_edge = np.concatenate([[0], np.cumsum(counts)[:-1]])
        within = np.array([within for _, within, _ in sides])
        reach = [reach + (shape.radius if within else -shape.radius) for shape, within, reach in sides]
        self.reach = np.array(reach)[self.owner]
        self.start, self.along = edges[:, 0], edges[:, 1] - edges[:, 0]
        squared = (self.along**2).sum(-1, keepdims=True)
        self.along_share = self.along / np.where(squared > 0, squared, 1)
        # A point or a line has no inside: lenses that stay within its reach are on the way out wherever they are.
        self.flat = np.array([shape.core.area == 0 for shape, _, _ in sides])
        self.sign = np.where(self.flat & within, -1.0, 1.0)[self.owner]
        self.within = within
        end = edges[:, 1]
        rise = end[:, 1] - self.start[:, 1]
        self.low, self.high, self.lean = self.start[:, 1], end[:, 1], self.along[:, 0] / np.where(rise != 0, rise, 1)
        # The way to go from right on an edge, where a lens off the back is held by its bounds: inward, or away from a keep-out.
        outward = outward_normals(torch.from_numpy(edges)).numpy()
        self.inward = np.where(within[self.owner], -1.0, 1.0)[:, None] * outward
        self.first, self.second = np.triu_indices(len(question.lenses), 1)
        self.clearance = np.array([lens.clearance for lens in question.lenses])
        self.least_apart = self.clearance[self.first] + self.clearance[self.second] + question.gap

    def __call__(self, layout: Layout) -> Room:
        """Give the room left at every limit of layouts on the processor, in float64."""
        position, radius = layout.position.detach().double().numpy(), layout.aperture_radius.detach().double().numpy()
        return Room(*(torch.from_numpy(part) for part in self.at(position, radius)))

    def at(
        self, position: Float[np.ndarray, "*batch n 2"], radius: Float[np.ndarray, "*batch n"]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Give the four parts of a `Room`."""
        away = position[..., self.first, :] - position[..., self.second, :]
        distance = np.sqrt((away**2).sum(-1))
        apart = distance - (radius[..., self.first] + radius[..., self.second] + self.least_apart)
        parting = away / np.maximum(distance, TINY)[..., None]
        room, inward = self._at_edges(position)
        return apart, parting, room - (radius + self.clearance)[..., None], inward

    def _at_edges(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # Both axes one by one: an axis of two numbers is a slow one to sum over.
        x, y = (position[..., None, axis] - self.start[:, axis] for axis in (0, 1))
        share = x * self.along_share[:, 0] + y * self.along_share[:, 1]
        share = np.minimum(np.maximum(share, 0, out=share), 1, out=share)
        x -= share * self.along[:, 0]
        y -= share * self.along[:, 1]
        distance = np.sqrt(x * x + y * y)
        sign, counts = self._signs(position, distance)
        room = sign * distance + self.reach
        per_distance = sign / np.maximum(distance, TINY)
        inward = np.stack([per_distance * x, per_distance * y], axis=-1)
        if counts is not None:
            room = np.where(counts, room, self.no_limit)
        on_edge = distance == 0
        if on_edge.any():
            inward = np.where(on_edge[..., None], self.inward, inward)
        return room, inward

    def _signs(self, position: np.ndarray, distance: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """Give the sign of each distance, and which edges count at all, None where all do.

        On the wrong side of a shape only its nearest edge counts: that is where the lens has to go back.
        """
        if self.flat.all():
            return self.sign, None
        x, y = position[..., None, 0], position[..., None, 1]
        crossed = ((self.low > y) != (self.high > y)) & (x < self.start[:, 0] + (y - self.low) * self.lean)
        inside = np.add.reduceat(crossed, self.first_edge, axis=-1, dtype=int) % 2 == 1
        wrong = (inside != self.within) & ~self.flat
        if not wrong.any():
            return self.sign, None
        least = np.minimum.reduceat(distance, self.first_edge, axis=-1)[..., self.owner]
        lost, nearest = wrong[..., self.owner], distance == least
        return np.where(lost & nearest, -1.0, self.sign), ~lost | nearest
