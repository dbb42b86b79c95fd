"""Areas that discs share with each other and with a region: shapely's areas, with their shape derivatives for torch.

Shapely has no gradient, but the derivative of a shared area needs none: when a disc moves or grows, the area changes by the
part of its rim that lies inside the other shape times how fast that rim moves along its normal,

    dA/dc = integral of n ds,    dA/dr = integral of ds,    over the rim of the disc inside the other shape.

A disc is taken as a regular polygon of the same area; the derivatives are those of the polygon, so that value and gradient
agree to rounding.
"""

from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np
import shapely
import torch
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable

EDGES = 128
"""Of the polygon that stands for a disc. Its corners lie 2e-4 of the radius outside the circle and the middles of its edges
1e-4 inside, so an area is between those of discs that much larger and smaller; the error falls with the square of EDGES."""


def regular_polygon(edges: int) -> tuple[Float[np.ndarray, "e 2"], float]:
    """Give the corners of the regular polygon around the origin that has the area of the unit disc, and its inner radius.

    The inner radius is also how fast an edge moves outward when the polygon grows with its disc.
    """
    outer = sqrt(2 * pi / (edges * sin(2 * pi / edges)))
    angle = 2 * pi * np.arange(edges) / edges
    return outer * np.stack([np.cos(angle), np.sin(angle)], axis=-1), outer * cos(pi / edges)


_CORNER, _EDGE_PER_RADIUS = regular_polygon(EDGES)


def overlap_area(
    first_centre: Float[Tensor, "*batch 2"],
    first_radius: Float[Tensor, "*batch"],
    second_centre: Float[Tensor, "*batch 2"],
    second_radius: Float[Tensor, "*batch"],
) -> Float[Tensor, "*batch"]:
    """Give the area that two discs share, mm^2, differentiable in both centres and both radii (once).

    Args:
        first_centre: mm.
        first_radius: mm, > 0.
        second_centre: mm.
        second_radius: mm, > 0.
    """
    return _OverlapArea.apply(first_centre, first_radius, second_centre, second_radius)  # type: ignore[return-value]


def outside_area(
    centre: Float[Tensor, "*batch 2"], radius: Float[Tensor, "*batch"], region: BaseGeometry
) -> Float[Tensor, "*batch"]:
    """Give the area of a disc that lies outside a region, mm^2, differentiable in centre and radius (once).

    Args:
        centre: mm.
        radius: mm, > 0.
        region: polygon with holes or parts, mm.
    """
    return _OutsideArea.apply(centre, radius, region)  # type: ignore[return-value]


class _OverlapArea(Function):
    @staticmethod
    def forward(ctx: Any, *discs: Tensor) -> Tensor:
        first_centre, first_radius, second_centre, second_radius = discs
        distance = (first_centre - second_centre).norm(dim=-1)
        near = (distance < (first_radius + second_radius) * (1 + 1 / EDGES)).numpy().ravel()
        first, second = _polygons(first_centre, first_radius)[near], _polygons(second_centre, second_radius)[near]
        area = np.zeros(near.shape)
        area[near] = shapely.area(shapely.intersection(first, second))
        ctx.save_for_backward(
            *_spread(_rim_integrals(first, second), near, first_centre),
            *_spread(_rim_integrals(second, first), near, second_centre),
        )
        return torch.from_numpy(area).reshape(first_radius.shape).to(first_radius)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, ...]:  # type: ignore[override]
        normals_1, length_1, normals_2, length_2 = ctx.saved_tensors
        along = grad.unsqueeze(-1)
        return along * normals_1, grad * length_1, along * normals_2, grad * length_2


class _OutsideArea(Function):
    @staticmethod
    def forward(ctx: Any, centre: Tensor, radius: Tensor, region: BaseGeometry) -> Tensor:
        discs = _polygons(centre, radius)
        shapely.prepare(region)
        near = ~shapely.covers(region, discs)
        area = np.zeros(near.shape)
        # The difference of two like areas would lose half of the digits just where a disc begins to leave.
        area[near] = shapely.area(shapely.difference(discs[near], region))
        normals, length = _spread(_rim_integrals(discs[near], region, outside=True), near, centre)
        ctx.save_for_backward(normals, length)
        return torch.from_numpy(area).reshape(radius.shape).to(radius)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, grad: Tensor) -> tuple[Tensor, Tensor, None]:  # type: ignore[override]
        normals, length = ctx.saved_tensors
        return grad.unsqueeze(-1) * normals, grad * length, None


def _polygons(centre: Tensor, radius: Tensor) -> np.ndarray:
    middle, size = (
        centre.detach().double().reshape(-1, 1, 2).numpy(),
        radius.detach().double().reshape(-1, 1, 1).numpy(),
    )
    return np.asarray(shapely.polygons(middle + size * _CORNER))


def _rim_integrals(discs: np.ndarray, others: Any, outside: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Integrate the outward normal, and the speed of the rim as the radius grows, over the rim inside (outside) the others."""
    cut = shapely.difference if outside else shapely.intersection
    pieces, owner = shapely.get_parts(cut(shapely.boundary(discs), others), return_index=True)
    corners, piece = shapely.get_coordinates(pieces, return_index=True)
    step, follows = corners[1:] - corners[:-1], piece[1:] == piece[:-1]
    disc = owner[piece[1:][follows]] if len(piece) else np.empty(0, dtype=int)
    step, middle = step[follows], (corners[1:] + corners[:-1])[follows] / 2
    normal = np.stack([step[:, 1], -step[:, 0]], axis=-1)
    outward = np.sign((normal * (middle - _centroids(discs)[disc])).sum(-1, keepdims=True))
    normals, length = np.zeros((len(discs), 2)), np.zeros(len(discs))
    np.add.at(normals, disc, outward * normal)
    np.add.at(length, disc, np.linalg.norm(step, axis=-1) * _EDGE_PER_RADIUS)
    return normals, length


def _centroids(discs: np.ndarray) -> np.ndarray:
    return shapely.get_coordinates(shapely.centroid(discs))


def _spread(integrals: tuple[np.ndarray, np.ndarray], near: np.ndarray, centre: Tensor) -> tuple[Tensor, Tensor]:
    """Put the integrals of the discs that were looked at among zeros for the rest, in the shape of the batch."""
    normals, length = np.zeros((len(near), 2)), np.zeros(len(near))
    normals[near], length[near] = integrals
    return (
        torch.from_numpy(normals).reshape(centre.shape).to(centre),
        torch.from_numpy(length).reshape(centre.shape[:-1]).to(centre),
    )
