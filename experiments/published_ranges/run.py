"""Hold the working ranges that the photometric cues predict against those that makers publish; tables and a figure.

python experiments/published_ranges/run.py
"""

from dataclasses import fields
from pathlib import Path

import figures
import torch
from predict import DEPTHS, Band, asked, band, errors, shift_per_error
from published import CLAIMS, MEAN_ABSOLUTE, Claim
from settings import Setting, settings
from systems import LENSES, PREDICT
from torch import Tensor

from multilens.plot.figures import save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"
PITCH = {"d3s": 0.002, "oak_d": 0.003}
"""mm, by the presets."""

BASELINE = {"d3s": 4.0, "oak_d": 75.0}
"""mm, published."""

HEAD = (
    "system",
    "texture of",
    "measured by",
    "mean absolute error",
    "published (m)",
    "settings",
    "that keep it anywhere",
    "that keep it over all that is published",
    "near end: nearest, median, farthest (m)",
    "far end: nearest, median, farthest (m)",
)


TEXTURES = {"one size": False, "all sizes": True}

DECIDING = {"D3S": "both", "Focal Split": "defocus", "Focal Track": "focus follows"}
"""Systems of which more than texture and light is not published, and how they measure."""


def metres(numbers: tuple[float, ...]) -> str:
    return ", ".join(_metres(number) for number in numbers)


def _metres(number: float) -> str:
    first, last = DEPTHS[0].item(), DEPTHS[-1].item()
    sign = "<" if number <= first else ">" if number >= last else ""
    return f"{sign}{number / 1000:.3g}"


def line(band: Band) -> list[str]:
    claim = band.claim
    return [
        claim.title,
        band.texture,
        band.way,
        claim.error,
        f"{claim.near / 1000:g} to {claim.far / 1000:g}",
        str(band.count),
        f"{band.measuring:.0%}",
        f"{band.covering:.0%}",
        metres(band.spread(0)) if band.ends else "-",
        metres(band.spread(1)) if band.ends else "-",
    ]


def deciding_lines(band: Band, swept: list[Setting]) -> list[list[str]]:
    """Tell for each value of each swept parameter which share of the settings covers the published range."""
    names = [(field.name,) for field in fields(Setting)]
    lines = []
    for each in [*names, ("contrast", "light_lux")]:
        values = [tuple(getattr(setting, name) for name in each) for setting in swept]
        if len(set(values)) > 1:
            shares = (f"{_words(value)}: {_covering(band, values, value)}" for value in dict.fromkeys(values))
            lines.append([band.claim.title, band.claim.error, " and ".join(each), ", ".join(shares)])
    return lines


def _words(value: tuple[float, ...]) -> str:
    return " and ".join(f"{number:g}" for number in value)


def _covering(band: Band, values: list[tuple[float, ...]], value: tuple[float, ...]) -> str:
    chosen = torch.tensor([each == value for each in values])
    return f"{band.covers[chosen].double().mean().item():.0%}"


def shift_line(claim: Claim, texture: str, stereo: Tensor) -> list[str]:
    """Tell which error of the shift the published far end means, and which ones the bound allows at that depth."""
    pixels = (
        shift_per_error(claim.far, BASELINE[claim.system], LENSES[claim.system][0].focal_length) / PITCH[claim.system]
    )
    allowed = claim.mm if claim.mm is not None else claim.far * (claim.percent or 0.0) / 100
    published = pixels * allowed / MEAN_ABSOLUTE
    at = stereo[:, (DEPTHS - claim.far).abs().argmin()]
    bounds = sorted((pixels * at[at.isfinite()]).tolist())
    least, median, most = bounds[0], bounds[len(bounds) // 2], bounds[-1]
    return [
        claim.title,
        texture,
        f"{claim.error} at {claim.far / 1000:g} m",
        f"{published:.3g}",
        f"{least:.2g}, {median:.2g}, {most:.2g}",
        f"{published / median:.2g}",
    ]


def gain_lines(found: dict[str, Tensor], swept: list[Setting]) -> list[list[str]]:
    """Tell for each difference of the foci by how much defocus lowers the error of D3S' stereo in the published range."""
    saved = 1 - (found["both"] / found["stereo"])[:, asked(CLAIMS[0])]
    lines = []
    for change in dict.fromkeys(setting.power_change for setting in swept):
        chosen = saved[torch.tensor([setting.power_change == change for setting in swept])]
        seen = chosen[chosen.isfinite()]
        lines.append([f"{change:g}", f"{seen.median().item():.2%}", f"{seen.max().item():.1%}"])
    return lines


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    bands, shifts, deciding, gains = [], [], [], []
    for texture, all_sizes in TEXTURES.items():
        swept = {system: list(settings(system, all_sizes)) for system in PREDICT}
        found = {system: errors(system, swept[system]) for system in PREDICT}
        here = [band(claim, texture, way, error) for claim in CLAIMS for way, error in found[claim.system].items()]
        bands += here
        stereo = [claim for claim in CLAIMS if claim.system in PITCH]
        shifts += [shift_line(claim, texture, found[claim.system]["stereo"]) for claim in stereo]
        if all_sizes:
            gains = gain_lines(found["d3s"], swept["d3s"])
            for each in here:
                if DECIDING.get(each.claim.title) == each.way:
                    deciding += deciding_lines(each, swept[each.claim.system])
    shift_head = (
        "system",
        "texture of",
        "published",
        "error of the shift that it means (pixels)",
        "by the bound: least, median, largest (pixels)",
        "published over median",
    )
    deciding_head = ("system", "mean absolute error", "swept", "settings that cover the published range, by value")
    tables = {
        "table": [HEAD, *(line(each) for each in bands)],
        "deciding": [deciding_head, *deciding],
        "gains": [("difference of D3S' foci (dioptres)", "defocus saves, median", "most"), *gains],
        "shifts": [shift_head, *shifts],
    }
    for name, table in tables.items():
        print(markdown_text(table))
        write_whole(RESULTS / f"{name}.csv", csv_text(table))
        write_whole(RESULTS / f"{name}.md", markdown_text(table))
    with style():
        save_figures({"ranges": figures.ranges(bands)}, RESULTS)


if __name__ == "__main__":
    main()
