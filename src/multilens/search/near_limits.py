"""The limits of a back as many layouts at once see them: around every lens a limited number of edges, whatever the outline.

A step of a search then costs the same on a back of twenty corners and of two thousand. Outlines are first given few edges on the
safe side; of these, a lens looks at the nearest in each of many directions from where it stands, looked up in a grid.
"""

from math import pi

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.geometry.distance import outward_normals
from multilens.geometry.pairs import pair_indices
from multilens.geometry.simplify import few_edges
from multilens.layout import Layout
from multilens.question import Question
from multilens.search.limits import TINY, Room

COARSE = 2e-4
"""Part of the back's diagonal by which outlines of many edges are made smaller to have few."""

DIRECTIONS = 12
"""In each of which a lens looks at the nearest edge, where there are many."""

FEW = 64
"""Edges that are all looked at: a limit that comes and goes as a lens moves makes steps shorter."""

CELLS = 24
"""Along each side of the back's bounding box, for which the edges are looked up."""

START, ALONG, SHARE, AT_START, AT_END, BETWEEN, REACH, SIGN = (
    slice(0, 2),
    slice(2, 4),
    slice(4, 6),
    slice(6, 8),
    slice(8, 10),
    slice(10, 12),
    12,
    13,
)
"""Where a row of the table of edges holds what: start, vector to the end, that by its squared length; the way out, from a lens'
side of the rim, at the start, at the end and between; the radius that is allowed beyond the edge; and the sign of the distance."""


class NearLimits:
    """The room that is left at each pair of lenses and at the edges near each lens.

    Args:
        question: whose lenses and back are taken.
        device: where to compute.
    """

    def __init__(self, question: Question, device: str | torch.device = "cpu") -> None:
        back, kind = question.back, {"dtype": torch.float64, "device": device}
        self.no_limit = back.size
        """mm; room that stands for an edge that limits nothing from where the lens is."""
        tolerance = COARSE * back.size
        sides = [(few_edges(back.outline, True, tolerance), True, 0.0)]
        sides += [(few_edges(keep.shape, False, tolerance), False, -keep.clearance) for keep in back.keep_outs]
        self.edges = torch.cat(
            [_rows(shape.segments, shape.radius, within, clear) for shape, within, clear in sides]
        ).to(**kind)
        left, top, right, bottom = back.outline.bounds
        self.corner = torch.tensor([left, top], **kind)
        self.per_cell = CELLS / torch.tensor([right - left, bottom - top], **kind)
        self.looked_at: Tensor | None = None
        if len(self.edges) > FEW:
            self.looked_at = torch.from_numpy(_nearest_by_direction(self.edges.cpu().numpy(), back.outline.bounds))
            self.looked_at = self.looked_at.to(device)
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
        edge = self.edges
        if self.looked_at is not None:
            cell = ((position - self.corner) * self.per_cell).long().clamp_(0, CELLS - 1)
            edge = edge[self.looked_at[cell[..., 0] * CELLS + cell[..., 1]]]
        from_start = position.unsqueeze(-2) - edge[..., START]
        share = (from_start * edge[..., SHARE]).sum(-1, keepdim=True).clamp_(0, 1)
        offset = from_start - share * edge[..., ALONG]
        distance = offset.norm(dim=-1)
        # At a corner the side is told by both its edges.
        outward = torch.where(share == 0, edge[..., AT_START], edge[..., BETWEEN]).where(share < 1, edge[..., AT_END])
        wrong = (offset * outward).sum(-1) > 0
        room = edge[..., SIGN] * distance + edge[..., REACH]
        inward = (edge[..., SIGN] / distance.clamp(min=TINY)).unsqueeze(-1) * offset
        nearest = distance == distance.amin(-1, keepdim=True)
        lost = nearest & wrong
        if lost.any():
            # On the wrong side of a rim only the nearest edge counts: that is where the lens has to go back.
            room = torch.where(
                lost, edge[..., REACH] - distance, room.masked_fill(lost.any(-1, keepdim=True), self.no_limit)
            )
            inward = torch.where(lost.unsqueeze(-1), -inward, inward)
        return room, inward


def _rows(segments: Float[np.ndarray, "e 2 2"], radius: float, within: bool, clearance: float) -> Float[Tensor, "e 14"]:
    """Give the table of a shape's edges."""
    edges = torch.from_numpy(segments)
    start, end = edges[:, 0], edges[:, 1]
    along = end - start
    squared = along.square().sum(-1, keepdim=True)
    flat = not bool((outward_normals(edges) @ (start.mean(0) - start).T).abs().max() > 0)
    outward = torch.zeros_like(along) if flat else outward_normals(edges) * (1.0 if within else -1.0)
    # Rings are closed: each edge begins where another ends.
    before = (start.unsqueeze(1) == end.unsqueeze(0)).all(-1).to(outward) @ outward
    after = (end.unsqueeze(1) == start.unsqueeze(0)).all(-1).to(outward) @ outward
    # A point or a line has no inside: a lens that stays within its reach is on the way out wherever it is.
    sign = -1.0 if flat and within else 1.0
    ends = torch.tensor([radius + clearance if within else clearance - radius, sign], dtype=edges.dtype)
    columns = [start, along, along / squared.where(squared > 0, 1), outward + before, outward + after, outward]
    return torch.cat([*columns, ends.expand(len(edges), 2)], dim=-1)


def _nearest_by_direction(
    edges: Float[np.ndarray, "e 14"], bounds: tuple[float, float, float, float]
) -> Int[np.ndarray, "c d"]:
    """Give for every cell of a grid the edges to look at: in each direction from its middle the nearest, else the next ones."""
    left, top, right, bottom = bounds
    middle = (np.arange(CELLS) + 0.5) / CELLS
    x, y = np.meshgrid(left + middle * (right - left), top + middle * (bottom - top), indexing="ij")
    point = np.stack([x.ravel(), y.ravel()], axis=-1)[:, None]
    from_start = point - edges[:, START]
    share = (from_start * edges[:, SHARE]).sum(-1).clip(0, 1)[..., None]
    offset = from_start - share * edges[:, ALONG]
    distance = np.hypot(offset[..., 0], offset[..., 1])
    direction = ((np.arctan2(offset[..., 1], offset[..., 0]) / (2 * pi) + 0.5) * DIRECTIONS).astype(int) % DIRECTIONS
    # The nearest of each direction comes before all others, which follow by their distance.
    order = distance.argsort(axis=1, kind="stable")
    ranked = np.take_along_axis(direction, order, axis=1)
    later = np.ones_like(ranked, dtype=bool)
    for each in range(DIRECTIONS):
        found = ranked == each
        first = found.argmax(axis=1)
        has = found.any(axis=1)
        later[np.flatnonzero(has), first[has]] = False
    chosen = later.argsort(axis=1, kind="stable")[:, :DIRECTIONS]
    # In the order of the edges, so that a limit keeps its place from one cell to the next where it can.
    return np.sort(np.take_along_axis(order, chosen, axis=1), axis=1)
