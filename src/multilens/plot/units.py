"""Numbers as a reader wants them: three digits that count, and one unit for all depths of a picture."""

from dataclasses import dataclass
from math import floor, log10

from multilens.problem import Problem

METRE = 1000.0
"""mm"""


@dataclass(frozen=True)
class DepthUnit:
    """The unit in which a picture gives its depths.

    Args:
        name: mm or m.
        millimetres: how many make one.
    """

    name: str
    millimetres: float

    def number(self, depth: float) -> str:
        """Write a depth given in mm, without its unit."""
        return significant(depth / self.millimetres)

    def text(self, depth: float) -> str:
        """Write a depth given in mm, with its unit."""
        return f"{self.number(depth)} {self.name}"

    def range(self, near: float, far: float) -> str:
        """Write a range given in mm, both ends to the same decimals, two of the nearest's digits at least."""
        least = near / self.millimetres
        decimals = max(2 if self.millimetres > 1 else 0, 1 - floor(log10(least)))
        return f"{least:.{decimals}f} to {far / self.millimetres:.{decimals}f} {self.name}"


def depth_unit(problem: Problem) -> DepthUnit:
    """Give metres where the depths reach a metre, millimetres where they do not."""
    return DepthUnit("m", METRE) if problem.depths.max().item() >= METRE else DepthUnit("mm", 1.0)


def significant(number: float, digits: int = 3) -> str:
    """Write a number to so many digits that count, never as a power of ten between 1e-4 and 1e6, zeros kept: 4.80."""
    if number == 0 or not 1e-4 <= abs(number) < 1e6:
        return f"{number:.{digits}g}"
    rounded = float(f"{number:.{digits - 1}e}")
    return f"{rounded:.{max(0, digits - 1 - floor(log10(abs(rounded))))}f}"


def round_length(longest: float) -> float:
    """Give the largest of 1, 2, 5, 10, ... (and 0.5, 0.2, ...) mm that is not longer."""
    power = 10.0 ** floor(log10(longest))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= longest)
