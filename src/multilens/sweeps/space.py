"""What an exploration may choose from: for each key a span of numbers or a list of values."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite

DIGITS = 6
"""Of a number that was chosen: more would only make tables hard to read."""

BETWEEN = 0.382
"""Part of the way from the least to the largest number at which one is looked at: between whole ends it is hardly ever whole."""


@dataclass(frozen=True)
class Span:
    """Numbers from low to high, both included.

    Args:
        key: what they are values of, such as back.outline.width.
        low: the least.
        high: the largest, > low.
        step: from one number to the next, counted from low; None for any number.
        whole: whether they are whole numbers.
        log: whether factors count rather than differences; low must be > 0 and there is no step then.

    Raises:
        ValueError: a number is out of its range.
    """

    key: str
    low: float
    high: float
    step: float | None = None
    whole: bool = False
    log: bool = False

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            if not isfinite(getattr(self, name)):
                raise ValueError(f"{self.key}: {name} must be finite, got {getattr(self, name)}")
        if self.low >= self.high:
            raise ValueError(f"{self.key}: must go from a number to a larger one, got {self.low:g} to {self.high:g}")
        if self.step is not None and not 0 < self.step <= self.high - self.low:
            raise ValueError(f"{self.key}: step must be > 0 and at most {self.high - self.low:g}, got {self.step:g}")
        if self.log and self.low <= 0:
            raise ValueError(f"{self.key}: log must begin at a number > 0, got {self.low:g}")
        if self.log and self.step not in (None, 1):
            raise ValueError(f"{self.key}: log must have no step, got {self.step:g}")

    @property
    def ends(self) -> tuple[str, ...]:
        """The least and the largest, as text, and of numbers that need not be whole one between, which what is counted refuses."""
        low, high = self.text(self.low), self.text(self.high)
        between = self.low + (BETWEEN * (self.high - self.low) if self.step is None else self.step)
        return (low, high) if self.whole else tuple(dict.fromkeys((low, high, self.text(between))))

    def text(self, value: float) -> str:
        """Give a number of the span as it is written, with six digits where that does not leave the span."""
        if self.whole:
            return str(round(value))
        short = f"{value:.{DIGITS}g}"
        return short if self.low <= float(short) <= self.high else repr(float(value))


@dataclass(frozen=True)
class Choice:
    """Values without an order.

    Args:
        key: what they are values of, such as depth.
        values: as they are written, two or more, each once.

    Raises:
        ValueError: there are fewer, or one comes twice.
    """

    key: str
    values: tuple[str, ...]

    def __post_init__(self) -> None:
        if len(set(self.values)) < len(self.values) or len(self.values) < 2:
            raise ValueError(f"{self.key}: must be two or more values, each once, got {', '.join(self.values)}")

    @property
    def ends(self) -> tuple[str, ...]:
        """All of them."""
        return self.values


Space = tuple[Span | Choice, ...]


def each_end(space: Space) -> Iterator[tuple[str, list[str]]]:
    """Give key=value for every key, at the first ends and then with another one of one key, which is told; "" at first."""
    first = {each.key: each.ends[0] for each in space}
    yield "", _lines(first)
    for each in space:
        for end in each.ends[1:]:
            yield f"{each.key}={end}", _lines(first | {each.key: end})


def _lines(values: Mapping[str, str]) -> list[str]:
    return [f"{key}={value}" for key, value in values.items()]
