"""How much room a lens has on the back, and how much of it the lenses take."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import Protocol, runtime_checkable

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn.functional import grid_sample

from multilens.back import Back
from multilens.geometry.distance import signed_distance
from multilens.geometry.pairs import pair_distance, pair_indices
from multilens.layout import Layout
from multilens.lens import Lens

MOST_EDGES_EXACT = 8
"""Beyond this many edges a back is sampled for the wide search, so that a step costs the same for any outline."""


def body_radius(layout: Layout, lenses: Sequence[Lens]) -> Float[Tensor, "*batch n"]:
    """Give the radius of the disc that each lens needs for itself, A + clearance, mm."""
    clearance = torch.tensor([lens.clearance for lens in lenses], dtype=torch.float64)
    return layout.aperture_radius + clearance.to(layout.aperture_radius)


def pair_room(layout: Layout, lenses: Sequence[Lens], gap: float) -> Float[Tensor, "*batch p"]:
    """Give the space between the bodies of every pair, less the gap they must keep, mm; negative where they are too close."""
    radius = body_radius(layout, lenses)
    first, second = pair_indices(layout.count, radius.device)
    return pair_distance(layout.position) - radius[..., first] - radius[..., second] - gap


@runtime_checkable
class Room(Protocol):
    """The largest body radius that fits around a point, by each of the things that limit it."""

    def __call__(self, point: Float[Tensor, "*batch n 2"]) -> Float[Tensor, "*batch n m"]:
        """Give the radius that each limit leaves at each point, mm; negative outside the back."""
        ...


@dataclass(frozen=True)
class ExactRoom:
    """Room by exact distances, to the outline and to each keep-out less its clearance; a step costs time for every edge."""

    back: Back

    def __call__(self, point: Float[Tensor, "*batch n 2"]) -> Float[Tensor, "*batch n m"]:
        """Give the radius that the outline and each keep-out leave, mm."""
        outline = self.back.outline
        within = -signed_distance(point, torch.from_numpy(outline.segments).to(point), outline.radius)
        clear = [
            signed_distance(point, torch.from_numpy(keep_out.shape.segments).to(point), keep_out.shape.radius)
            - keep_out.clearance
            for keep_out in self.back.keep_outs
        ]
        return torch.stack([within, *clear], dim=-1)


def room_at(back: Back, x: Float[np.ndarray, "*m"], y: Float[np.ndarray, "*m"]) -> Float[np.ndarray, "*m"]:
    """Give the body radius that the nearest limit leaves around many points at once, mm, exact and without a gradient."""
    limits = [-back.outline.signed_distance(x, y)]
    limits += [keep_out.shape.signed_distance(x, y) - keep_out.clearance for keep_out in back.keep_outs]
    return np.minimum.reduce(limits)


class SampledRoom:
    """Room read off a grid by linear interpolation: the same cost for any number of edges, and exact only at the nodes.

    Between nodes it is off by at most half a cell's diagonal: distances change no faster than one moves.

    Args:
        back: where lenses may stand.
        cells: along the longer side of the back's bounding box.
    """

    def __init__(self, back: Back, cells: int = 96) -> None:
        left, top, right, bottom = back.outline.bounds
        width, height = right - left, bottom - top
        spacing = max(width, height) / cells
        x = np.linspace(left, right, ceil(width / spacing) + 1)
        y = np.linspace(top, bottom, ceil(height / spacing) + 1)
        at_x, at_y = np.meshgrid(x, y)
        self.grid = torch.from_numpy(room_at(back, at_x, at_y))[None, None]
        self.corner = torch.tensor([left, top], dtype=torch.float64)
        self.size = torch.tensor([width, height], dtype=torch.float64)

    def __call__(self, point: Float[Tensor, "*batch n 2"]) -> Float[Tensor, "*batch n 1"]:
        """Give the radius that the nearest limit leaves, mm; a point off the bounding box is read at its rim."""
        at = 2 * (point - self.corner.to(point)) / self.size.to(point) - 1
        room = grid_sample(self.grid.to(point), at.reshape(1, -1, 1, 2), padding_mode="border", align_corners=True)
        return room.reshape(*point.shape[:-1], 1)


def quick_room(back: Back) -> Room:
    """Give the room that is fastest to ask many times: exact for few edges, sampled for many."""
    shapes = [back.outline, *(keep_out.shape for keep_out in back.keep_outs)]
    return ExactRoom(back) if sum(len(shape.segments) for shape in shapes) <= MOST_EDGES_EXACT else SampledRoom(back)
