"""Units of length: read from a file or told by the user, never guessed."""

from difflib import get_close_matches
from math import isclose

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "inch": 25.4, "ft": 304.8}
"""What a user can say, and how many millimetres each is."""

ROUNDING = 1e-9
"""Part of a scale; what differs by less is the same unit."""


def scale_of(told: str | None, found: float | None, where: str, hint: str) -> float:
    """Give the millimetres that a unit of a file is.

    Args:
        told: by the user, one of `MILLIMETRES`; None where nothing was said.
        found: in the file, mm; None where it says nothing.
        where: in the file units are looked for.
        hint: how the user can say it.

    Raises:
        ValueError: neither says it, both do and differ, or the user's unit is unknown.
    """
    if told is not None and told not in MILLIMETRES:
        near = get_close_matches(told, MILLIMETRES, n=1, cutoff=0.3)
        guess = f"; did you mean {near[0]}?" if near else ""
        raise ValueError(f"units must be one of {', '.join(MILLIMETRES)}, got {told}{guess}")
    if told is None and found is None:
        raise ValueError(f"units must be known, got a file without them ({where}): say which, as in {hint}")
    if told is None or found is None:
        return MILLIMETRES[told] if told is not None else found or 0.0
    if not isclose(MILLIMETRES[told], found, rel_tol=ROUNDING):
        raise ValueError(
            f"units must be those of the file, in which 1 is {found:g} mm ({where}), or not be given, got {told}"
        )
    return found
