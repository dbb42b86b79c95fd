"""The free unknowns of a question as one vector of numbers of like size, and back again."""

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.layout import Layout
from multilens.question import Question


class Variables:
    """A vector x for every layout: what is free, scaled so that 0 to 1 spans its range.

    Positions are scaled by the longer side of the back's bounding box, radii by their bounds, foci by the logarithm of
    theirs. What is locked, and what has equal bounds, is left out.

    Args:
        question: whose lenses and back give the ranges.
        dtype: of the vectors.
        device: of the vectors.
    """

    def __init__(
        self, question: Question, dtype: torch.dtype = torch.float64, device: str | torch.device = "cpu"
    ) -> None:
        kind = {"dtype": dtype, "device": device}
        lenses = question.lenses
        left, top, right, bottom = question.back.outline.bounds
        side = max(right - left, bottom - top)
        locks = [lens.position or (None, None) for lens in lenses]
        axes = [(low, place) for lock in locks for low, place in zip((left, top), lock, strict=True)]
        place_low = [low if place is None else place for low, place in axes]
        place_span = [side if place is None else 0.0 for _, place in axes]
        radii = [lens.aperture_radius for lens in lenses]
        foci = [focus for lens, focus in zip(lenses, question.focus_range, strict=True) for _ in range(lens.tiers)]

        self.count = len(lenses)
        tiers = max(lens.tiers for lens in lenses)
        first = [sum(lens.tiers for lens in lenses[:i]) for i in range(self.count)]
        # A tier that a lens does not have reads the focus of its first.
        self.tier_of = torch.tensor(
            [[first[i] + (t if t < lens.tiers else 0) for t in range(tiers)] for i, lens in enumerate(lenses)],
            dtype=torch.long,
            device=device,
        )
        low = [*place_low, *(low for low, _ in radii), *(near for near, _ in foci)]
        high = [
            *(a + b for a, b in zip(place_low, place_span, strict=True)),
            *(h for _, h in radii),
            *(far for _, far in foci),
        ]
        self.low = torch.tensor(low, **kind)
        self.high = torch.tensor(high, **kind)
        # Told in double precision whatever the type, so that vectors of both have the same elements.
        free = [index for index, (least, largest) in enumerate(zip(low, high, strict=True)) if largest > least]
        self.free = torch.tensor(free, dtype=torch.long, device=device)
        self.focus_start = 3 * self.count
        limit = torch.ones_like(self.low)
        limit[0 : 2 * self.count : 2] = (right - left) / side
        limit[1 : 2 * self.count : 2] = (bottom - top) / side
        self.upper = limit[self.free]
        """Largest value of each element of x; the least is 0."""
        self.span = (self.high - self.low)[self.free]
        """What one unit of each element of x is in mm (positions and radii; foci are not linear)."""
        start = self.focus_start
        ratio = (self.high[start:] / self.low[start:]).log()
        self.stretch = torch.cat([(self.high - self.low)[:start], ratio])
        """What one unit of every unknown is: mm of positions and radii, the logarithm of foci; 0 if it is not free."""

    def __len__(self) -> int:
        return len(self.free)

    def layout(self, x: Float[Tensor, "*batch d"]) -> Layout:
        """Give the layout that a vector stands for, differentiable."""
        return self.layout_of(self.spread(x))

    def spread(self, x: Float[Tensor, "*batch d"]) -> Float[Tensor, "*batch v"]:
        """Give x with a 0 for each unknown that is not free."""
        return x.new_zeros(*x.shape[:-1], len(self.low)).index_copy(-1, self.free, x)

    def layout_of(self, share: Float[Tensor, "*batch v"]) -> Layout:
        """Give the layout of a vector that has every unknown, free or not, differentiable."""
        n, start = self.count, self.focus_start
        linear = self.low[:start] + share[..., :start] * (self.high - self.low)[:start]
        near, far = self.low[start:], self.high[start:]
        focus = near * (far / near) ** share[..., start:]
        return Layout(linear[..., : 2 * n].unflatten(-1, (n, 2)), linear[..., 2 * n :], focus[..., self.tier_of])

    def slope_of(
        self,
        layout: Layout,
        position: Float[Tensor, "*batch n 2"],
        aperture_radius: Float[Tensor, "*batch n"],
        focus: Float[Tensor, "*batch n t"],
    ) -> Float[Tensor, "*batch v"]:
        """Give the derivative with respect to every unknown from those with respect to the parts of a layout; 0 if not free."""
        linear = torch.cat([position.flatten(-2), aperture_radius], dim=-1)
        own = linear.new_zeros(*linear.shape[:-1], len(self.low) - self.focus_start)
        own.index_add_(-1, self.tier_of.flatten(), (focus * layout.focus).flatten(-2))
        return torch.cat([linear, own], dim=-1) * self.stretch

    def vector(self, layout: Layout) -> Float[Tensor, "*batch d"]:
        """Give the vector of a layout, held to its bounds."""
        start = self.focus_start
        linear = torch.cat([layout.position.flatten(-2), layout.aperture_radius], dim=-1).to(self.low)
        own = torch.zeros(len(self.low) - start, dtype=torch.long, device=self.low.device)
        lens_tier = self.tier_of.flatten()
        own[lens_tier.flip(0)] = torch.arange(len(lens_tier), device=own.device).flip(0)
        focus = layout.focus.flatten(-2)[..., own].to(self.low)
        span = (self.high - self.low)[:start]
        near, far = self.low[start:], self.high[start:]
        ratio = (far / near).log()
        share = torch.cat(
            [
                (linear - self.low[:start]) / span.where(span > 0, 1),
                (focus / near).log() / ratio.where(ratio > 0, 1),
            ],
            dim=-1,
        )
        return share[..., self.free].clamp(min=0).minimum(self.upper)
