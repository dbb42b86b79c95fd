"""Numbers held to their range, where a noun is made: each refusal says name, expected, got."""

from math import isfinite

LEAST, MOST = 1e-20, 1e20
"""Of what is measured, whatever its unit: products of several squares of such numbers are still numbers."""


def refuse_unless_positive(name: str, value: float) -> None:
    """Refuse what is not a finite number above 0, or so small or large that nothing could be computed with it.

    Raises:
        ValueError: it is not, or it is.
    """
    if not isfinite(value) or value <= 0:
        raise ValueError(f"{name} must be > 0 and finite, got {value:g}")
    if not LEAST <= value <= MOST:
        raise ValueError(f"{name} must be from {LEAST:g} to {MOST:g}, got {value:g}")


def refuse_unless_not_negative(name: str, value: float) -> None:
    """Refuse what is not a finite number from 0 on.

    Raises:
        ValueError: it is not.
    """
    if not isfinite(value) or value < 0:
        raise ValueError(f"{name} must be >= 0 and finite, got {value:g}")


def refuse_unless_share(name: str, value: float) -> None:
    """Refuse what is not above 0 and at most 1.

    Raises:
        ValueError: it is not.
    """
    if not 0 < value <= 1:
        raise ValueError(f"{name} must be > 0 and <= 1, got {value:g}")


def refuse_unless_range(name: str, value: tuple[float, float]) -> None:
    """Refuse what is not two finite numbers above 0, the least first.

    Raises:
        ValueError: it is not.
    """
    if len(value) != 2:
        raise ValueError(f"{name} must be two numbers, least and largest, got {len(value)}")
    least, largest = value
    refuse_unless_positive(f"least {name}", least)
    refuse_unless_positive(f"largest {name}", largest)
    if least > largest:
        raise ValueError(f"{name} must have least <= largest, got {least:g} > {largest:g}")
