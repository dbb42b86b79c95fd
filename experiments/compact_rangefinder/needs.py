"""What one number of the rangefinder must be for the published range, all others as they are."""

from dataclasses import dataclass
from math import exp, log

from rangefinder import Rangefinder, changed


@dataclass(frozen=True)
class Number:
    """A number that is changed alone.

    Args:
        name: of a Rangefinder.
        words: for people, with the unit.
        least: from where on it is looked for.
        most: up to where.
        why: what the two ends are.
    """

    name: str
    words: str
    least: float
    most: float
    why: str


NUMBERS = (
    Number("aperture_radius", "aperture radius (mm)", 0.1, 2.0, "two apertures touch at 2 mm"),
    Number("power_change", "difference of the foci (dioptres)", 0.01, 6.0, "lens 2 then focuses at infinity"),
    Number("contrast", "contrast", 0.01, 1.0, "all there is"),
    Number("pixels", "pixels read together", 25, 1e6, "5 x 5 to 1000 x 1000"),
    Number("light_lux", "light (lux)", 10, 1e5, "to sunlight; from 1500 lux on the pixels are full"),
    Number("baseline", "baseline (mm)", 1.0, 400.0, "a hundredfold"),
)

STEPS = 120
"""Values that are tried, each the same factor beyond the last; an interval that lies between two of them is missed."""

HALVINGS = 40


def needed(device: Rangefinder, number: Number, way: str) -> tuple[tuple[float, float], ...]:
    """Give the intervals of a number in which the device covers the published range, their ends found by halving."""

    def covers(place: float) -> bool:
        return changed(device, number.name, exp(place)).covers(way)

    low, high = log(number.least), log(number.most)
    places = [low + (high - low) * k / STEPS for k in range(STEPS + 1)]
    good = [covers(place) for place in places]
    found, start = [], None
    for k, inside in enumerate([*good, False]):
        if inside and start is None:
            start = low if k == 0 else _edge(covers, places[k], places[k - 1])
        elif not inside and start is not None:
            found.append((exp(start), exp(high if k > STEPS else _edge(covers, places[k - 1], places[k]))))
            start = None
    return tuple(found)


def _edge(covers, inside: float, outside: float) -> float:
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if covers(middle) else (inside, middle)
    return inside
