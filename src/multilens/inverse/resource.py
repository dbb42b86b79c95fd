"""What a design is given and could do with less of: lenses, the size of the back, the width of the apertures."""

from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

from multilens.lens import Lens
from multilens.problem import Problem

BARELY = 0.999
"""Part of the size at which the widest lens just fits across the back: there it does not fit."""


@runtime_checkable
class Resource(Protocol):
    """A problem as a function of how much there is of something; whoever has more can do all that could be done with less."""

    @property
    def name(self) -> str:
        """What there is more or less of, with its unit."""
        ...

    @property
    def problem(self) -> Problem:
        """The problem as it was asked."""
        ...

    def with_only(self, value: float) -> Problem:
        """Give the problem with so much of it."""
        ...

    def words(self, value: float) -> str:
        """Say how much it is."""
        ...


@dataclass(frozen=True, eq=False)
class LensCount:
    """How many lenses: those of the problem in their order, the last of them again and again where more are asked for.

    Of a layout with one lens more, the others alone are a layout too: if n lenses do not fit, no more do.

    Args:
        problem: whose lenses are taken.
    """

    problem: Problem
    name = "lenses"

    def with_only(self, value: float) -> Problem:
        """Give the problem with so many lenses."""
        return replace(self.problem, lenses=self.lenses(int(value)))

    def lenses(self, count: int) -> tuple[Lens, ...]:
        """Give so many lenses."""
        own = self.problem.lenses
        return (own + own[-1:] * count)[:count]

    def words(self, value: float) -> str:
        """Say how many."""
        return f"{int(value)}"


@dataclass(frozen=True, eq=False)
class BackSize:
    """The size of the back: all lengths of its outline, round corners too, as a part of what they are.

    The outline shrinks about its middle. What stands on the back stays where it is, and as large as it is.

    Args:
        problem: whose back is taken as size 1.

    Raises:
        ValueError: the outline shrunk about its middle is not within itself: a smaller back might hold what a larger does not.
    """

    problem: Problem
    name = "size"

    def __post_init__(self) -> None:
        if not self.problem.back.outline.holds_its_shrunken_self:
            raise ValueError(
                "outline must hold itself shrunk about its middle for a smallest size to be sought, "
                "got one with a hole, parts or too deep a notch"
            )

    @property
    def least(self) -> float:
        """A size at which the widest lens does not fit even at its smallest aperture."""
        left, top, right, bottom = self.problem.back.outline.bounds
        widest = max(lens.least_body_radius for lens in self.problem.lenses)
        return BARELY * 2 * widest / min(right - left, bottom - top)

    def with_only(self, value: float) -> Problem:
        """Give the problem with a back of this size."""
        return replace(self.problem, back=self.problem.back.scaled(value))

    def words(self, value: float) -> str:
        """Say the size, and what the outline measures."""
        outline = self.problem.back.outline.scaled(value)
        left, top, right, bottom = outline.bounds
        return f"{value:.4g}: {right - left:.4g} x {bottom - top:.4g} mm, {outline.polygon().area:.4g} mm2"


@dataclass(frozen=True, eq=False)
class WidestAperture:
    """The aperture radius that no lens may exceed.

    Args:
        problem: whose lenses have it beside their own bounds.

    Raises:
        ValueError: the lenses' own bounds leave nothing to choose.
    """

    problem: Problem
    name = "aperture radius (mm)"

    def __post_init__(self) -> None:
        if not self.least < self.most:
            raise ValueError(
                "lenses must have apertures to choose from for a smallest one to be sought, "
                f"got {self.least:g} to {self.most:g} mm"
            )

    @property
    def least(self) -> float:
        """Radius below which some lens cannot go, mm."""
        return max(lens.aperture_radius[0] for lens in self.problem.lenses)

    @property
    def most(self) -> float:
        """Radius beyond which no lens can go, mm."""
        return max(lens.aperture_radius[1] for lens in self.problem.lenses)

    def with_only(self, value: float) -> Problem:
        """Give the problem with apertures of this radius at most."""
        return replace(self.problem, lenses=[_stopped_down(lens, value) for lens in self.problem.lenses])

    def words(self, value: float) -> str:
        """Say the radius, and the f-number where all lenses have one focal length."""
        lengths = {lens.focal_length for lens in self.problem.lenses}
        f_number = f" (f/{lengths.pop() / (2 * value):.3g})" if len(lengths) == 1 else ""
        return f"{value:.4g}{f_number}"


def _stopped_down(lens: Lens, most: float) -> Lens:
    least, own = lens.aperture_radius
    return replace(lens, aperture_radius=(least, min(own, most)))
