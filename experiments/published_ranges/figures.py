"""The study's picture: what is published beside which share of the settings predicts it."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from predict import DEPTHS, Band

PUBLISHED, PREDICTED = "#d55e00", "Blues"
SPAN = (0.05, 30.0)
"""m; what is drawn."""


def ranges(bands: Sequence[Band]) -> Figure:
    """A strip for every system and way to measure: the darker, the more of the settings keep the error there."""
    textures = list(dict.fromkeys(band.texture for band in bands))
    rows = len(bands) // len(textures)
    figure, panels = plt.subplots(
        1, len(textures), figsize=(14, 0.5 * rows + 1.6), sharex=True, sharey=True, layout="constrained"
    )
    for ax, texture in zip(panels, textures, strict=True):
        _strips(ax, [band for band in bands if band.texture == texture])
        ax.set_title(f"texture of {texture}", fontsize=11)
    panels[0].plot([], [], color=PUBLISHED, linewidth=4, label="published")
    shades = ScalarMappable(Normalize(0, 1), PREDICTED)
    figure.colorbar(shades, ax=panels, label="settings that keep the error", aspect=30, pad=0.01, format="{x:.0%}")
    figure.legend(loc="outside upper left", frameon=False)
    return figure


def _strips(ax: Axes, bands: Sequence[Band]) -> None:
    metres = DEPTHS / 1000
    for row, band in enumerate(bands):
        edges, share = [row - 0.15, row + 0.38], band.share[None, :-1]
        ax.pcolormesh(metres, edges, share, cmap=PREDICTED, vmin=0, vmax=1, rasterized=True)
        published = [band.claim.near / 1000, band.claim.far / 1000]
        ax.plot(published, [row - 0.27] * 2, color=PUBLISHED, linewidth=4, solid_capstyle="butt")
    ax.set_yticks(range(len(bands)), [f"{band.claim.title}, {band.way}, {band.claim.error}" for band in bands])
    ax.set(xscale="log", xlim=SPAN, ylim=(len(bands) - 0.4, -0.6), xlabel="depth (m)")
    ax.set_xticks([0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20], ["0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10", "20"])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.tick_params(axis="y", length=0)
