"""Colours that colour-blind readers tell apart, fonts, and files that come out the same to the byte."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib import rc_context
from matplotlib.colors import to_hex, to_rgb

from multilens.cues import Measurement

INK, FAINT, RULE, PAPER, WARNING, KEPT = "#1a1a1a", "#6b6b6b", "#c9c9c9", "#ffffff", "#b3261e", "#1b6e3c"

FONT_SIZE, SMALL_FONT_SIZE, TITLE_FONT_SIZE = 11.0, 9.5, 16.0
"""Points."""

LENS_COLOURS = (
    "#0072b2",  # blue
    "#e69f00",  # orange
    "#009e73",  # green
    "#cc79a7",  # pink
    "#56b4e9",  # sky
    "#d55e00",  # vermilion
    "#aa4499",  # purple
    "#999933",  # olive
    "#332288",  # indigo
    "#ddcc77",  # sand
    "#882255",  # wine
    "#44aa99",  # teal
)
"""The palettes of Okabe and Ito and of Paul Tol, their neutral colours left to stereo; a thirteenth lens begins again."""

PAIR_COLOURS = ("#262626", "#7a6a58", "#5d6b78", "#8c8c8c", "#4a3b47", "#a89f91")
"""Near-neutral, so that no pair looks like a lens."""

PAIR_DASHES = ((None, None), (6.0, 2.0), (1.5, 1.5), (6.0, 1.5, 1.5, 1.5))

TIER_TINTS = (0.0, 0.35, 0.6, 0.2, 0.5)
"""Share of white in the colour of a lens' first, second, ... tier."""


@contextmanager
def style() -> Iterator[None]:
    """Set the fonts and what makes files reproducible, until the block ends; figures are made and saved inside it."""
    settings: dict[Any, Any] = {
        "font.family": "sans-serif",
        "font.sans-serif": ["DejaVu Sans"],
        "font.size": FONT_SIZE,
        "text.color": INK,
        "axes.edgecolor": FAINT,
        "axes.labelcolor": INK,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "xtick.color": INK,
        "ytick.color": INK,
        "hatch.linewidth": 0.6,
        # Hinting makes words wider at some resolutions than at others: they would not keep the places found for them.
        "text.hinting": "none",
        "svg.fonttype": "path",
        "svg.hashsalt": "multilens",
    }
    with rc_context(settings):
        yield


def lens_colour(lens: int) -> str:
    """Give the colour of a lens by its index from 0, whatever other lenses there are."""
    return LENS_COLOURS[lens % len(LENS_COLOURS)]


def measurement_colour(measurement: Measurement) -> str:
    """Give the colour of a measurement: of a lens its own, a tint of it for its later tiers; of a pair a near-neutral one.

    Nothing at all is the grey of rules.
    It depends on the measurement alone, so that adding a lens recolours nothing.
    """
    if not measurement.lenses:
        return RULE
    if len(measurement.lenses) == 1:
        tier = measurement.tier or 0
        return tint(lens_colour(measurement.lenses[0]), TIER_TINTS[tier % len(TIER_TINTS)])
    return PAIR_COLOURS[_pair_rank(measurement) % len(PAIR_COLOURS)]


def measurement_dashes(measurement: Measurement) -> tuple[float | None, ...]:
    """Give the dashes of a measurement's line, in line widths: unbroken for a lens, a pattern of its own for a pair's colour."""
    if len(measurement.lenses) == 1:
        return PAIR_DASHES[0]
    return PAIR_DASHES[_pair_rank(measurement) // len(PAIR_COLOURS) % len(PAIR_DASHES)]


def tint(colour: str, white: float) -> str:
    """Mix a colour with white; 0 leaves it, 1 is white."""
    red, green, blue = ((1 - white) * part + white for part in to_rgb(colour))
    return to_hex((red, green, blue))


def shade(colour: str, black: float) -> str:
    """Mix a colour with black, for words in a colour that is too light for them; 0 leaves it, 1 is black."""
    red, green, blue = ((1 - black) * part for part in to_rgb(colour))
    return to_hex((red, green, blue))


def ink_on(colour: str) -> str:
    """Give the ink, dark or white, that contrasts most with a colour, by relative luminance (WCAG 2)."""
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in to_rgb(colour)]
    luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return PAPER if 1.05 / (luminance + 0.05) > (luminance + 0.05) / 0.06 else INK


def _pair_rank(measurement: Measurement) -> int:
    """Number a pair so that the pairs of a lens come after all pairs of the lenses before it: 1-2, 1-3, 2-3, 1-4, ..."""
    first, second = min(measurement.lenses), max(measurement.lenses)
    return second * (second - 1) // 2 + first
