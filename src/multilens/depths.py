"""Depths spread over a range, and how much each counts."""

from collections.abc import Sequence
from itertools import pairwise
from math import isfinite

import torch
from jaxtyping import Float
from torch import Tensor


def linear_depths(near: float, far: float, count: int = 512) -> Float[Tensor, " z"]:
    """Give depths evenly spaced from near to far, both included.

    Args:
        near: mm, > 0.
        far: mm, > near.
        count: how many, >= 2.

    Raises:
        ValueError: a number is out of its range.
    """
    _refuse_unless_depth_range(near, far, count)
    return torch.linspace(near, far, count, dtype=torch.float64)


def log_depths(near: float, far: float, count: int = 512) -> Float[Tensor, " z"]:
    """Give depths from near to far, both included, each the same factor beyond the last.

    Args:
        near: mm, > 0.
        far: mm, > near.
        count: how many, >= 2.

    Raises:
        ValueError: a number is out of its range.
    """
    _refuse_unless_depth_range(near, far, count)
    depths = near * (far / near) ** torch.linspace(0, 1, count, dtype=torch.float64)
    # Rounding would put the ends beside what was asked for.
    depths[0], depths[-1] = near, far
    return depths


def histogram_weights(
    depths: Float[Tensor, " z"], edges: Sequence[float], shares: Sequence[float]
) -> Float[Tensor, " z"]:
    """Give weights by which the depths of each bin of a histogram count together as much as the bin does.

    Args:
        depths: mm.
        edges: of the bins, ascending, mm, at least two; a depth at an edge belongs to the bin beyond it, the last to the last bin.
        shares: of each bin, >= 0, any scale, not all 0; one fewer than edges.

    Returns:
        Weights that sum to 1; within a bin all are alike.

    Raises:
        ValueError: edges or shares are no histogram, a depth lies outside all bins, or a bin with a share has no depth.
    """
    _refuse_unless_histogram(edges, shares)
    bounds, share = (torch.tensor(numbers, dtype=torch.float64) for numbers in (edges, shares))
    if not ((depths >= bounds[0]) & (depths <= bounds[-1])).all():
        raise ValueError(f"edges must enclose all depths, got {edges[0]:g} to {edges[-1]:g} mm")
    at = torch.searchsorted(bounds, depths.contiguous(), right=True).clamp(max=len(share)) - 1
    count = torch.bincount(at, minlength=len(share))
    if ((count == 0) & (share > 0)).any():
        raise ValueError("every bin with a share must have a depth in it: more depths, or wider bins")
    return (share / share.sum() / count)[at]


def _refuse_unless_histogram(edges: Sequence[float], shares: Sequence[float]) -> None:
    if not shares or len(edges) != len(shares) + 1:
        raise ValueError(f"shares must be one fewer than edges, at least one, got {len(shares)} and {len(edges)}")
    if not all(first < last for first, last in pairwise(edges)):
        raise ValueError(f"edges must ascend, got {', '.join(f'{edge:g}' for edge in edges[:8])}")
    if not all(isfinite(share) and share >= 0 for share in shares) or not sum(shares) > 0:
        raise ValueError("shares must be finite and >= 0, not all 0")


def _refuse_unless_depth_range(near: float, far: float, count: int) -> None:
    if not (isfinite(near) and near > 0):
        raise ValueError(f"near must be > 0 mm and finite, got {near:g}")
    if not (isfinite(far) and far > near):
        raise ValueError(f"far must be > near = {near:g} mm and finite, got {far:g}")
    if not isinstance(count, int) or count < 2:
        raise ValueError(f"count must be a whole number >= 2, got {count}")
