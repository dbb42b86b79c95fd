"""What is not published, swept over ranges that were fixed before the first prediction; none was changed afterwards.

The texture of all sizes was added after the predictions with a texture of one size had been seen: the README tells why.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import nan

import multilens as ml

CONTRASTS = (0.03, 0.1, 0.3)
"""From plaster or skin to print, in one band of frequencies."""

PERIODS = (4, 8, 16)
"""Of the texture, pixels: from the finest that a filter of a few pixels reads, two octaves up."""

SCALES = (4, 8, 16, 32, 64)
"""Periods of a texture of all sizes, pixels, an octave apart; the two largest are a later addition, see the README."""

SIDES = (5, 11, 21)
"""Of the square of pixels read together: from the least that matchers and differential filters use to a large one."""

LIGHTS = (100.0, 500.0, 2000.0)
"""lux, at 1/30 s: a living room, an office, under a lamp."""

POWER_CHANGES = (0.06, 0.2, 0.6)
"""Dioptres between the two images: from what Coupled Optical Differentiation uses (arXiv 2409.10725) to ten times that."""

QUARTERS = (0.25, 0.5, 0.75)
"""Where the focus midway between the two images lies in the published range, as a part of its dioptres, from the far end."""

D3S_F_NUMBERS = (3.0, 4.0, 6.0, 8.0)
"""From two apertures that touch on 4 mm."""

D3S_PITCHES = (1.4, 2.0, 3.45)
"""um; 1800 pixels are then 2.5 to 6.2 mm behind 12 mm."""

SPLIT_F_NUMBERS = (2.8, 5.6, 11.0)
"""From wide to narrow for a lens off the shelf."""

SPLIT_FOCAL_LENGTHS = (20.0, 30.0, 50.0)
"""mm; of a camera that is held in a hand."""

SPLIT_PITCHES = (1.4, 3.0, 6.0)
"""um; from the pixels of small sensors to some of them binned, for 480 x 360 results."""


@dataclass(frozen=True)
class Setting:
    """One choice of all that is not published; no number where a system has no such thing, or it is published.

    Args:
        contrast: of the texture.
        period: of the texture, pixels; None for a texture of all sizes.
        side: of the square of pixels read together, pixels.
        light_lux: at 1/30 s.
        power_change: between the two images, dioptres.
        quarter: where the focus lies.
        f_number: of the lens.
        pitch_um: of the pixels.
        focal_length: mm.
    """

    contrast: float
    period: int | None
    side: int
    light_lux: float
    power_change: float = nan
    quarter: float = nan
    f_number: float = nan
    pitch_um: float = nan
    focal_length: float = nan

    def scene(self, pitch_um: float) -> ml.Scene:
        """Give the scene that a sensor of this pixel pitch reads."""
        assert self.period is not None
        frequency = 1000 / (self.period * pitch_um)
        return ml.Scene(self.contrast, frequency, self.light_lux, exposure_ms=33.3, pixels=self.side**2)


SWEPT: dict[str, dict[str, tuple[float, ...]]] = {
    "d3s": {
        "power_change": POWER_CHANGES,
        "quarter": QUARTERS,
        "f_number": D3S_F_NUMBERS,
        "pitch_um": D3S_PITCHES,
    },
    "focal_split": {
        "power_change": POWER_CHANGES,
        "quarter": QUARTERS,
        "f_number": SPLIT_F_NUMBERS,
        "pitch_um": SPLIT_PITCHES,
        "focal_length": SPLIT_FOCAL_LENGTHS,
    },
    "focal_track": {"power_change": POWER_CHANGES},
    "oak_d": {},
}
"""Beside contrast, period, side and light, which no system publishes."""


def settings(system: str, all_sizes: bool = False) -> Iterator[Setting]:
    """Give every setting of a system; a square holds at least one period of the texture, or it could not be told apart."""
    own, periods = SWEPT[system], (None,) if all_sizes else PERIODS
    for contrast, period, side, light in product(CONTRASTS, periods, SIDES, LIGHTS):
        if period is None or side >= period:
            for choice in product(*own.values()):
                yield Setting(contrast, period, side, light, **dict(zip(own, choice, strict=True)))


def sizes(setting: Setting) -> tuple[Setting, ...]:
    """Give the textures of one size that a setting may read, the coarse ones in a square of one period."""
    if setting.period is not None:
        return (setting,)
    return tuple(replace(setting, period=period, side=max(setting.side, period)) for period in SCALES)
