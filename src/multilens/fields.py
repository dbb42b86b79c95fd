"""Plain data taken apart with care: every field is checked for its type and its range, and every refusal names the key.

What is read comes from a file that anyone may have written. Nothing in it is imported, called or trusted; a name here is the
path of a key from the top of the file, such as `problem.lenses[0].focal_length`.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import isfinite
from typing import Any

LONGEST_SHOWN = 40
"""Characters of what was found that a message repeats."""


def record(value: object, name: str, keys: Sequence[str], optional: Sequence[str] = ()) -> dict[str, Any]:
    """Take a record that must have these keys, may have the optional ones, and no others.

    Raises:
        ValueError: it is no record, a key is missing or one is unknown.
    """
    if not isinstance(value, dict):
        raise ValueError(f"{name} must be a record with {', '.join(keys)}, got {_shown(value)}")
    for key in value:
        if key not in keys and key not in optional:
            known = ", ".join([*keys, *optional]) or "none"
            raise ValueError(f"{name} must have the keys {known}, got the unknown key {_shown(key)}")
    for key in keys:
        if key not in value:
            raise ValueError(f"{name} must have the keys {', '.join(keys)}, got none called {key}")
    return value


def items(value: object, name: str, count: int | None = None) -> list[Any]:
    """Take a list, of a given length if one is given.

    Raises:
        ValueError: it is no list, or of another length.
    """
    expected = "a list" if count is None else f"a list of {count}"
    if not isinstance(value, list):
        raise ValueError(f"{name} must be {expected}, got {_shown(value)}")
    if count is not None and len(value) != count:
        raise ValueError(f"{name} must be {expected}, got {len(value)}")
    return value


def number(value: object, name: str) -> float:
    """Take a finite number.

    Raises:
        ValueError: it is no number, or none that a float can hold.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{name} must be a number, got {_shown(value)}")
    try:
        as_float = float(value)
    except OverflowError:
        as_float = float("inf")
    if not isfinite(as_float):
        raise ValueError(f"{name} must be a finite number, got {_shown(value)}")
    return as_float


def numbers(value: object, name: str, count: int | None = None) -> list[float]:
    """Take a list of finite numbers, of a given length if one is given; refused as `items` and `number` are."""
    return [number(item, f"{name}[{index}]") for index, item in enumerate(items(value, name, count))]


def whole_number(value: object, name: str) -> int:
    """Take a whole number.

    Raises:
        ValueError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(f"{name} must be a whole number, got {_shown(value)}")
    return value


def text(value: object, name: str) -> str:
    """Take a text.

    Raises:
        ValueError: it is none.
    """
    if not isinstance(value, str):
        raise ValueError(f"{name} must be a text, got {_shown(value)}")
    return value


def flag(value: object, name: str) -> bool:
    """Take true or false.

    Raises:
        ValueError: it is neither.
    """
    if not isinstance(value, bool):
        raise ValueError(f"{name} must be true or false, got {_shown(value)}")
    return value


def choice(value: object, name: str, allowed: Sequence[str]) -> str:
    """Take one of a few texts.

    Raises:
        ValueError: it is none of them.
    """
    if not isinstance(value, str) or value not in allowed:
        raise ValueError(f"{name} must be one of {', '.join(allowed)}, got {_shown(value)}")
    return value


@contextmanager
def within(name: str) -> Iterator[None]:
    """Put the path of a key before the message of any ValueError inside, which speaks of what it was given alone."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None


def _shown(value: object) -> str:
    if isinstance(value, dict | list):
        return f"a {'record' if isinstance(value, dict) else 'list'} of {len(value)}"
    # A whole number of thousands of digits cannot even be written out.
    whole = isinstance(value, int) and abs(value) > 10**LONGEST_SHOWN
    shown = "a number too large for a float" if whole else repr(value)
    return shown if len(shown) <= LONGEST_SHOWN else shown[:LONGEST_SHOWN] + "…"
