"""Where words go in a drawing: inside of what they name where they fit, else to its right."""

from collections.abc import Iterator
from dataclasses import dataclass

from multilens.cad.layers import clean
from multilens.cad.plan import Plan

WIDE = 0.62
"""Width of a letter, as a part of its height, in the usual sans-serif."""

AIR = 1.2
"""Times the height of words, that they need to stand in a gap, and a third of it that they keep from what is left of them."""


@dataclass(frozen=True)
class Label:
    """Words in a drawing.

    Args:
        words: one short line.
        x: of the middle of the words, or of where they begin, mm.
        y: of the middle of their height, mm.
        centred: whether x is of their middle.
    """

    words: str
    x: float
    y: float
    centred: bool


def labels(plan: Plan, height: float) -> Iterator[Label]:
    """Give the number of each lens and the name of each keep-out.

    Args:
        plan: with either direction of y.
        height: of the words, mm.
    """
    for stand in plan.stands:
        inside = stand.body_radius - stand.aperture_radius >= AIR * height
        between = (stand.body_radius + stand.aperture_radius) / 2
        right = stand.x + stand.body_radius + AIR * height / 3
        number = str(stand.number)
        yield Label(number, stand.x, stand.y + between, True) if inside else Label(number, right, stand.y, False)
    for keep_out in plan.back.keep_outs:
        words, (x, y) = clean(keep_out.name), keep_out.shape.middle
        left, top, right, bottom = keep_out.shape.bounds
        inside = bottom - top >= AIR * height and right - left >= AIR * WIDE * height * len(words)
        yield Label(words, x, y, True) if inside else Label(words, right + AIR * height / 3, y, False)
