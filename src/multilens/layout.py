"""A layout: the unknowns of a design, one or a whole batch of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor


@dataclass(frozen=True)
class Layout:
    """Where the lenses stand, how wide they open and where they focus.

    Numbers may be given as tensors or as (nested) lists; lists and whole numbers become float64. A focus without tiers,
    [*batch, n], is read as one tier. A lens of fewer tiers than others repeats its first focus in the places it does not
    have.

    Args:
        position: centre of each lens, mm, [*batch, n, 2].
        aperture_radius: radius A of each entrance pupil, mm, [*batch, n].
        focus: in-focus depth of each tier, mm, [*batch, n, t].

    Raises:
        ValueError: the three do not speak of the same number of lenses.
    """

    position: Float[Tensor, "*batch n 2"]
    aperture_radius: Float[Tensor, "*batch n"]
    focus: Float[Tensor, "*batch n t"]

    def __init__(
        self, position: Tensor | Sequence, aperture_radius: Tensor | Sequence, focus: Tensor | Sequence
    ) -> None:
        place, radius, depth = (_as_tensor(numbers) for numbers in (position, aperture_radius, focus))
        if depth.ndim == radius.ndim:
            depth = depth.unsqueeze(-1)
        if place.shape != (*radius.shape, 2) or depth.shape[:-1] != radius.shape:
            raise ValueError(
                "position, aperture_radius and focus must be [*batch, n, 2], [*batch, n] and [*batch, n, t], "
                f"got {list(place.shape)}, {list(radius.shape)} and {list(depth.shape)}"
            )
        object.__setattr__(self, "position", place)
        object.__setattr__(self, "aperture_radius", radius)
        object.__setattr__(self, "focus", depth)

    @property
    def count(self) -> int:
        """Number of lenses n."""
        return self.position.shape[-2]

    def __getitem__(self, index: int | slice | Tensor) -> "Layout":
        return Layout(self.position[index], self.aperture_radius[index], self.focus[index])

    def only(self, lenses: Sequence[int]) -> "Layout":
        """Give the layout of some of the lenses, by their indices, in the order given."""
        if tuple(lenses) == tuple(range(self.count)):
            return self
        chosen = torch.tensor(lenses, dtype=torch.long, device=self.position.device)
        parts = (self.position, self.aperture_radius, self.focus)
        dimension = self.aperture_radius.ndim - 1
        return Layout(*(part.index_select(dimension, chosen) for part in parts))

    def to(self, dtype: torch.dtype) -> "Layout":
        """Give the same layout in another floating-point type."""
        return Layout(self.position.to(dtype), self.aperture_radius.to(dtype), self.focus.to(dtype))


def _as_tensor(numbers: Tensor | Sequence) -> Tensor:
    if isinstance(numbers, Tensor):
        return numbers if numbers.is_floating_point() else numbers.double()
    return torch.tensor(numbers, dtype=torch.float64)
