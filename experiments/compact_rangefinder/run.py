"""Ask a rangefinder of two lenses 4 mm apart for its working range with and without defocus, and what it needs; tables, figure.

python experiments/compact_rangefinder/run.py
"""

from pathlib import Path

import figures
from needs import NUMBERS, Number, needed
from rangefinder import ALL_SIZES, DIFFERENTIAL, HALVES, OFFICE, WAYS, Rangefinder, noise

from multilens.plot.figures import save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"
TEXTURES = {"one size": OFFICE, "all sizes": ALL_SIZES}
CHANGES = (0.06, DIFFERENTIAL, 0.6, HALVES, 2.7)
"""Dioptres; at the last the foci are at both ends of the published range."""

Row = list[str]


def range_lines() -> list[Row]:
    lines = []
    for texture, periods in TEXTURES.items():
        for change in CHANGES:
            device = Rangefinder(power_change=change, periods=periods)
            foci = " and ".join(f"{focus / 1000:.2f}" for focus in device.foci)
            lines.append([texture, f"{change:.3g}", foci, *(_stretches(device, way) for way in WAYS)])
    return lines


def _stretches(device: Rangefinder, way: str) -> str:
    ends = device.working_range(way).intervals
    return ", ".join(f"{near / 1000:.3g} to {far / 1000:.3g}" for near, far in ends) or "nowhere"


def need_lines() -> list[Row]:
    lines = []
    for change in (DIFFERENTIAL, HALVES):
        device = Rangefinder(power_change=change)
        for number in NUMBERS:
            is_now = getattr(device, number.name)
            lines.append(
                [f"{change:.3g}", number.words, f"{is_now:.3g}", *(_needed(device, number, way) for way in WAYS)]
            )
        lines.append([f"{change:.3g}", "noise of a pixel", f"{noise(device):.2%}", *_noises(device)])
    return lines


def _needed(device: Rangefinder, number: Number, way: str) -> str:
    if number.name == "baseline" and way == "defocus":
        return "no matter"
    return ", ".join(_words(number, *ends) for ends in needed(device, number, way)) or "none"


def _words(number: Number, low: float, high: float) -> str:
    if low <= number.least * 1.001:
        return "any" if high >= number.most * 0.999 else f"to {high:.3g}"
    return f"{low:.3g} or more" if high >= number.most * 0.999 else f"{low:.3g} to {high:.3g}"


def _noises(device: Rangefinder) -> list[str]:
    """Tell from the contrast that is needed: the error of an amplitude depends on noise over contrast alone."""
    contrast = next(number for number in NUMBERS if number.name == "contrast")
    found = [needed(device, contrast, way) for way in WAYS]
    return [f"to {noise(device) * device.contrast / ends[0][0]:.2%}" if ends else "none" for ends in found]


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    by_way = [f"{way} (m)" for way in WAYS]
    tables = {
        "ranges": [["texture of", "difference (dioptres)", "foci (m)", *by_way], *range_lines()],
        "needs": [["difference (dioptres)", "number", "is", *(f"{way} needs" for way in WAYS)], *need_lines()],
    }
    for name, table in tables.items():
        print(markdown_text(table))
        write_whole(RESULTS / f"{name}.csv", csv_text(table))
        write_whole(RESULTS / f"{name}.md", markdown_text(table))
    with style():
        save_figures({"rangefinder": figures.rangefinder()}, RESULTS)


if __name__ == "__main__":
    main()
