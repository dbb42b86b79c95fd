"""The study's pictures: error against depth with and without defocus, and the working range against the difference of the foci."""

from math import nan

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from rangefinder import DIFFERENTIAL, FAR, HALVES, NEAR, SPAN, WAYS, Rangefinder, changed

import multilens as ml

COLOURS = {"stereo": "#262626", "defocus": "#0072b2", "both": "#d55e00"}
DASHES = {"stereo": "-", "defocus": "-", "both": (0, (2, 2))}
PUBLISHED = "0.85"
MEAN_ABSOLUTE = 0.797885
DEPTHS = ml.log_depths(100, 4000, 400)
LOOKED = ml.log_depths(*SPAN, 500)
CHANGES = ml.log_depths(0.02, 5.0, 60).tolist()
"""Dioptres."""


def rangefinder() -> Figure:
    """Mean absolute error against depth for two differences of the foci, and the working range against that difference."""
    figure, (near, far, range_) = plt.subplots(1, 3, figsize=(14, 5), layout="constrained")
    _errors(near, DIFFERENTIAL)
    _errors(far, HALVES)
    near.set_ylabel("mean absolute error (mm)")
    _ranges(range_)
    figure.legend(*near.get_legend_handles_labels(), loc="outside upper left", ncols=4, frameon=False)
    return figure


def _errors(ax: Axes, change: float) -> None:
    device = changed(Rangefinder(), "power_change", change)
    ax.axvspan(NEAR / 1000, FAR / 1000, color=PUBLISHED, zorder=0, label="published range")
    ax.axhline(10, color="0.5", linewidth=0.8, linestyle=":")
    for way in WAYS:
        error = device.errors(way, DEPTHS) * MEAN_ABSOLUTE
        ax.plot(DEPTHS / 1000, error, color=COLOURS[way], linestyle=DASHES[way], linewidth=1.8, label=way)
    first, second = (focus / 1000 for focus in device.foci)
    ax.set_title(f"foci at {first:.2f} and {second:.2f} m ({change:.2g} dioptres)", fontsize=11)
    ax.set(xscale="log", yscale="log", ylim=(0.02, 2000), xlim=(0.1, 4), xlabel="depth (m)")
    ax.set_xticks([0.1, 0.2, 0.5, 1, 2, 4], ["0.1", "0.2", "0.5", "1", "2", "4"])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.text(3.9, 11, "1 cm", va="bottom", ha="right", fontsize=9)


def _ranges(ax: Axes) -> None:
    ax.axhspan(NEAR / 1000, FAR / 1000, color=PUBLISHED, zorder=0)
    for way in ("stereo", "both", "defocus"):
        ends = [_ends(way, change) for change in CHANGES]
        for end in (0, 1):
            line = [pair[end] / 1000 for pair in ends]
            ax.plot(CHANGES, line, color=COLOURS[way], linestyle=DASHES[way], linewidth=1.8)
    for change in (DIFFERENTIAL, HALVES):
        ax.axvline(change, color="0.5", linewidth=0.8, linestyle=":")
    ax.set_title("both ends of the working range at 1 cm", fontsize=11)
    ax.set(xscale="log", yscale="log", ylim=(0.1, 4), xlabel="difference of the foci (dioptres)", ylabel="depth (m)")
    ax.set_xticks([0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5], ["0.02", "0.05", "0.1", "0.2", "0.5", "1", "2", "5"])
    ax.set_yticks([0.1, 0.2, 0.5, 1, 2, 4], ["0.1", "0.2", "0.5", "1", "2", "4"])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_minor_locator(NullLocator())


def _ends(way: str, change: float) -> tuple[float, float]:
    """Give the nearest and the farthest depth within tolerance, mm, or nothing to draw."""
    within = LOOKED[changed(Rangefinder(), "power_change", change).errors(way, LOOKED) * MEAN_ABSOLUTE <= 10].tolist()
    return (within[0], within[-1]) if within else (nan, nan)
