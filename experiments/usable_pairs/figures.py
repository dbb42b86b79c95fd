"""The study's pictures: which pair serves which depth, and from which depth on a pair may be used."""

from collections.abc import Mapping
from dataclasses import replace

import matplotlib.pyplot as plt
import torch
from cases import floor_error, nearest
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

import multilens as ml
from multilens.bands import NOTHING, winner_bands

plt.rcParams |= {
    "svg.hashsalt": "usable_pairs",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
}

COLOURS = {2: "#0072b2", 3: "#e69f00", 4: "#009e73", 5: "#cc79a7"}
"""By the number of lenses; the palette of Okabe and Ito."""

METRES = {200: "0.2", 500: "0.5", 1000: "1", 2000: "2", 5000: "5"}


def served(designs: Mapping[int, ml.Design]) -> Figure:
    """Draw the relative error against depth by the number of lenses, and below who serves which depth."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), sharex=True, height_ratios=(3, 2), layout="constrained")
    for row, (count, design) in enumerate(designs.items()):
        problem = design.problem
        assert isinstance(problem, ml.Problem)
        depths = problem.depths
        error = problem.errors(design.layout).amin(-2)
        above.plot(depths, 100 * error / depths, color=COLOURS[count], label=f"{count} lenses")
        for index, band in enumerate(winner_bands(problem, design.layout)):
            shade = 0.85 if index % 2 else 0.55
            look = {"color": COLOURS[count], "alpha": shade} if band.measurement != NOTHING else {"color": "0.9"}
            below.barh(row, band.far - band.near, left=band.near, height=0.8, **look)
            if band.far > 1.1 * band.near and band.measurement != NOTHING:
                i, j = band.measurement.lenses
                baseline = torch.dist(design.layout.position[i], design.layout.position[j]).item()
                middle = (band.near * band.far) ** 0.5
                below.text(middle, row, f"{baseline:.0f}", ha="center", va="center", fontsize=8)
    above.plot(depths, 100 * floor_error(depths) / depths, color="0.3", linestyle="--", label="any number of lenses")
    above.set(xscale="log", yscale="log", ylabel="error (% of depth)", xlim=(200, 5000))
    above.legend(frameon=False, ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    ticks = (0.05, 0.1, 0.2, 0.5)
    above.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    above.yaxis.set_minor_formatter(NullFormatter())
    above.grid(True, color="#ececec")
    below.set_yticks(range(len(designs)), [f"{count} lenses" for count in designs])
    below.set_xticks(list(METRES), list(METRES.values()))
    below.invert_yaxis()
    below.minorticks_off()
    below.set_xlabel("depth (m); the bars name the baseline of the best pair (mm)")
    return figure


def nearest_depths(unlike: ml.Problem) -> Figure:
    """Draw the depth from which on a pair may be used against its baseline, limit by limit."""
    main, _, tele = (replace(lens, near_focus=None) for lens in unlike.lenses)
    blind = [replace(lens, field_of_view_deg=None) for lens in (main, tele)]
    shift, overlap = ml.PairLimits(max_disparity=0.738), ml.PairLimits(least_overlap=0.5)
    lines = (
        ("a shift of 0.738 mm, main and tele", shift, (blind[0], blind[1]), "#009e73", "-"),
        ("a shift of 0.738 mm, two main cameras", shift, (blind[0], blind[0]), "#0072b2", "-"),
        ("half the field, two tele cameras", overlap, (tele, tele), "#d55e00", "--"),
        ("half the field, main and main or main and tele", overlap, (main, tele), "#cc79a7", "--"),
    )
    baselines = torch.logspace(0.5, 2.3, 200, dtype=torch.float64)
    figure, ax = plt.subplots(figsize=(6, 3.8), layout="constrained")
    for label, limits, pair, colour, dashes in lines:
        depths = nearest(limits, pair, baselines) / 1000
        ax.plot(baselines, depths, color=colour, linestyle=dashes, label=label)
    ax.axhline(0.2, color="0.4", linestyle=":", label="near focus of the main camera")
    ax.set(xscale="log", yscale="log", xlabel="baseline (mm)", ylabel="nearest usable depth (m)", ylim=(0.01, 5))
    ax.set_xticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    ax.set_yticks([0.01, 0.1, 1], ["0.01", "0.1", "1"])
    ax.minorticks_off()
    ax.grid(True, color="#ececec")
    ax.legend(frameon=False, fontsize=8)
    return figure
