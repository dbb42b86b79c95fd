"""The study's pictures: the thesis' figures 5.3, 5.4 and 7.1 redrawn, and the two valleys that explain them."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import torch
from line import ROOM, Profile
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from model import Arrangement, defocus_error, stereo_error

import multilens as ml

plt.rcParams |= {
    "svg.hashsalt": "thesis_two_lens",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
}

STEREO, DEFOCUS, LEAST, BACK = "#1f77b4", "#ff7f0e", "#2ca02c", "#cfe2f3"
"""The thesis' own colours: blue, orange, green, and the blue area of figure 7.1."""


def errors_by_depth() -> Figure:
    """Figures 5.3 and 5.4: both errors from 20 to 500 mm, and their minimum; baseline and aperture are equal here, 46 mm."""
    depths = ml.linear_depths(20, 500, 481)
    lenses = Arrangement(*(torch.tensor(value, dtype=torch.float64) for value in (46.0, 375.0, 23.0)))
    stereo, defocus = stereo_error(lenses, depths, 1.0), defocus_error(lenses, depths, 1.0)
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.4), sharey=True, layout="constrained")
    for ax in panels:
        ax.plot(depths, stereo, color=STEREO, label="stereo")
        ax.plot(depths, defocus, color=DEFOCUS, label="defocus (DFDD)")
        ax.set(xlabel="depth Z (mm)", xlim=(20, 500), ylim=(0, None))
    panels[0].set(ylabel="depth error per mm on the sensor (mm)", title="Figure 5.3: both errors")
    panels[1].plot(depths, torch.minimum(stereo, defocus), color=LEAST, linewidth=3, label="the less of both")
    panels[1].set_title("Figure 5.4: their minimum")
    for place, text, side in ((187.5, "equal at Zf/2 ", "right"), (375.0, " in focus at Zf", "left")):
        panels[1].axvline(place, ymax=0.4, color="0.6", linewidth=0.8, linestyle=":")
        panels[1].text(place, 1900, text, color="0.35", ha=side)
    for ax in panels:
        ax.legend(loc="upper left", frameon=False)
    return figure


def arrangements(rows: Sequence[dict], ranges: Sequence[tuple[int, int]], length: float) -> Figure:
    """Figure 7.1: the line in blue, both apertures in green; as printed, as found by descent, and the optimum."""
    columns = (
        ("printed", 6.0, "printed in the thesis"),
        ("exhaustive", 6.0, "optimum, ratio 6"),
        ("descent, median of 20", 6.0, "descent, ratio 6\n(median of 20 seeds)"),
        ("descent, median of 20", 1.0, "descent, ratio 1\n(median of 20 seeds)"),
    )
    size = (2.3 * len(columns), 2.35 * len(ranges))
    figure, panels = plt.subplots(len(ranges), len(columns), figsize=size, layout="constrained", squeeze=False)
    for line, (near, far) in zip(panels, ranges, strict=True):
        for ax, (what, ratio, title) in zip(line, columns, strict=True):
            row = next(one for one in rows if (one["near"], one["ratio"], one["what"]) == (near, ratio, what))
            gap, diameter = row["gap"], row["aperture_diameter"]
            ax.add_patch(Rectangle((0, -25), length, 50, color=BACK, zorder=0))
            ax.add_patch(Circle((1, 0), 1, color=LEAST))
            ax.add_patch(Circle((2 + gap + diameter / 2, 0), diameter / 2, color=LEAST, alpha=0.75))
            if gap > 1:
                arrow = {"arrowstyle": "<->", "color": STEREO, "shrinkA": 0, "shrinkB": 0}
                ax.annotate("", (2, 0), (2 + gap, 0), arrowprops=arrow)
            ax.set(xlim=(-1, 51), ylim=(-26, 26), aspect="equal", yticks=[])
            ax.set_xticks([0, 25, 50], ["0", "25", "50 mm"])
            ax.spines[:].set_visible(False)
            caption = f"b {gap:.1f}  2A {diameter:.1f}  Zf {row['focus']:.0f}\nloss {row['of_optimum']:.2f} x optimum"
            ax.set_xlabel(caption, fontsize=8)
            if near == ranges[0][0]:
                ax.set_title(title, fontsize=9)
        line[0].set_ylabel(f"{near}-{far} mm", fontsize=10)
    return figure


def valleys(
    ranges: Sequence[tuple[int, int]],
    profiles: Sequence[Profile],
    printed_gap: Sequence[float],
    descent_gap: Sequence[torch.Tensor],
    ratio: float,
) -> Figure:
    """Least loss at every gap along the line: a valley at each end and a ridge between them."""
    figure, ax = plt.subplots(figsize=(8, 4.6), layout="constrained")
    for k, ((near, far), profile) in enumerate(zip(ranges, profiles, strict=True)):
        cost = profile.loss / profile.loss.min()
        colour = f"C{k}"
        ax.plot(profile.gap, cost, color=colour, label=f"{near}-{far} mm")
        for gaps, marker, size in ((torch.tensor([printed_gap[k]]), "D", 9), (descent_gap[k], "|", 10)):
            at = gaps.double().clamp(0, profile.gap[-1].item())
            index = (at / profile.gap[1]).round().long()
            ax.plot(
                at, cost[index], marker, color=colour, markersize=size, markeredgecolor=None if marker == "|" else "k"
            )
    ax.plot([], [], "D", color="w", markeredgecolor="k", label="printed row")
    ax.plot([], [], "|", color="k", markersize=10, label="where 20 descents stand")
    ax.set(
        xlabel=f"gap b (mm); the aperture takes the rest, 2A = {ROOM:g} - b",
        ylabel="least loss / optimum",
        yscale="log",
    )
    ax.minorticks_off()
    ax.set_yticks([1, 1.5, 2, 2.5, 3], ["1", "1.5", "2", "2.5", "3"])
    ax.set_title(f"Two valleys: only defocus (left) or only stereo (right), f_stereo / f_dfdd = {ratio:g}")
    ax.legend(frameon=False, fontsize=8, loc="upper left")
    return figure
