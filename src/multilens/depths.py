"""Depths spread over a range."""

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


def _refuse_unless_depth_range(near: float, far: float, count: int) -> None:
    if not (isfinite(near) and near > 0):
        raise ValueError(f"near must be > 0 mm and finite, got {near:g}")
    if not (isfinite(far) and far > near):
        raise ValueError(f"far must be > near = {near:g} mm and finite, got {far:g}")
    if not isinstance(count, int) or count < 2:
        raise ValueError(f"count must be a whole number >= 2, got {count}")
