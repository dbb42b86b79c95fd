"""A tolerance: how far off a measured depth may be."""

from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True)
class Tolerance:
    """The largest error of depth that is good enough, in mm, in % of the depth, or both: then both must be kept.

    Args:
        mm: the same at every depth, > 0; None for no such limit.
        percent: of the depth, > 0; None for no such limit.

    Raises:
        ValueError: neither is given, or one is out of its range.
    """

    mm: float | None = None
    percent: float | None = None

    def __post_init__(self) -> None:
        if self.mm is None and self.percent is None:
            raise ValueError("tolerance must have mm, percent or both, got neither")
        for name, limit in (("mm", self.mm), ("percent", self.percent)):
            if limit is not None and not (isfinite(limit) and limit > 0):
                raise ValueError(f"{name} must be > 0 and finite, got {limit:g}")

    def __str__(self) -> str:
        parts = [] if self.mm is None else [f"{self.mm:g} mm"]
        parts += [] if self.percent is None else [f"{self.percent:g} % of the depth"]
        return " and ".join(parts)
