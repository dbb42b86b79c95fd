"""What is published of each system, and where."""

from dataclasses import dataclass
from math import pi, sqrt

MEAN_ABSOLUTE = sqrt(2 / pi)
"""Mean absolute error over standard deviation, of errors that are Gaussian."""


@dataclass(frozen=True)
class Claim:
    """A working range as its makers state it.

    Args:
        system: short name, a key of `systems.PREDICT`.
        title: for people.
        near: mm.
        far: mm.
        mm: mean absolute error that is kept, mm; None where a share of the depth is.
        percent: mean absolute error that is kept, % of the depth; None where it is in mm.
        stated: whether the makers state that error where we could read them; else it is one of two that we try.
    """

    system: str
    title: str
    near: float
    far: float
    mm: float | None = None
    percent: float | None = None
    stated: bool = True

    @property
    def error(self) -> str:
        """The mean absolute error, for people."""
        shown = f"{self.mm:g} mm" if self.mm is not None else f"{self.percent:g} %"
        return shown if self.stated else f"{shown} (tried)"


OAK_D_NEAR = 697.0
"""mm; 882.5 pixels times 75 mm over 95 pixels is 696.7 mm."""

CLAIMS = (
    Claim("d3s", "D3S", 300, 1640, mm=10),
    Claim("focal_split", "Focal Split", 400, 1200, percent=5, stated=False),
    Claim("focal_split", "Focal Split", 400, 1200, percent=10, stated=False),
    Claim("focal_track", "Focal Track", 300, 1000, percent=5, stated=False),
    Claim("focal_track", "Focal Track", 300, 1000, percent=10, stated=False),
    Claim("oak_d", "OAK-D", OAK_D_NEAR, 4000, percent=2),
    Claim("oak_d", "OAK-D", OAK_D_NEAR, 7000, percent=4),
    Claim("oak_d", "OAK-D", OAK_D_NEAR, 10_500, percent=6),
)
