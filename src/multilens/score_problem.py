"""A question with a score of one's own."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from jaxtyping import Float
from torch import Tensor

from multilens.back import Back
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.question import refuse_unless_lenses_and_gap


@dataclass(frozen=True, eq=False)
class ScoreProblem:
    """Any score that can be computed from a layout, under the same constraints.

    The largest circles that fit a square, for one, are `score=lambda layout: -layout.aperture_radius`: of several numbers the
    largest counts, and it is minimised.

    Args:
        back: where lenses may stand.
        lenses: what is known of each, at least one; a lens without bounds of focus has the focus 1 mm.
        score: from a batch of layouts to a tensor `[*batch]` or `[*batch, m]`, differentiable by autograd; less is better.
        gap: distance that the lenses' bodies keep from each other, mm, >= 0.
    """

    back: Back
    lenses: tuple[Lens, ...]
    function: Callable[[Layout], Tensor]
    gap: float

    def __init__(self, back: Back, lenses: Sequence[Lens], score: Callable[[Layout], Tensor], gap: float = 0.0) -> None:
        refuse_unless_lenses_and_gap(lenses, gap)
        object.__setattr__(self, "back", back)
        object.__setattr__(self, "lenses", tuple(lenses))
        object.__setattr__(self, "function", score)
        object.__setattr__(self, "gap", float(gap))

    @property
    def focus_range(self) -> tuple[tuple[float, float], ...]:
        """Nearest and farthest in-focus depth of each lens, mm."""
        return tuple(lens.focus or (1.0, 1.0) for lens in self.lenses)

    @property
    def metric(self) -> None:
        """Say that the score has a unit of its own."""
        return None

    def terms(self, layout: Layout) -> Float[Tensor, "*batch m"]:
        """Give the numbers of which the largest is the score."""
        terms = self.function(layout)
        return terms.unsqueeze(-1) if terms.ndim == layout.aperture_radius.ndim - 1 else terms

    def score(self, layout: Layout) -> Float[Tensor, "*batch"]:
        """Give the largest of the terms."""
        return self.terms(layout).amax(-1)
