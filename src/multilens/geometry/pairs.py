"""Every pair of lenses: who they are and how far apart."""

import torch
from jaxtyping import Float, Int
from torch import Tensor


def pair_indices(count: int, device: torch.device | str | None = None) -> Int[Tensor, "2 p"]:
    """Give the first and the second member of all count (count - 1) / 2 pairs, in the order 0-1, 0-2, ..., 1-2, ..."""
    return torch.triu_indices(count, count, offset=1, device=device)


def pair_distance(position: Float[Tensor, "*batch n 2"]) -> Float[Tensor, "*batch p"]:
    """Give the distance of the centres of every pair, in the order of `pair_indices`.

    The gradient is the unit vector between the two; where they coincide it is 0 and finite.

    Args:
        position: centres, mm.

    Returns:
        Distances, mm, >= 0.
    """
    first, second = pair_indices(position.shape[-2], position.device)
    return (position[..., first, :] - position[..., second, :]).norm(dim=-1)
