"""The study's pictures: the bounds beside noisy images, and the phone's camera by light and aperture."""

import matplotlib.pyplot as plt
import torch
from cases import BASELINE, DEPTHS, F_NUMBERS, FOCUS, LIGHTS, defocus_bound, phone_errors, stereo_bound
from matplotlib.figure import Figure
from simulate import Camera

STEREO, DEFOCUS = "#262626", "#0072b2"
DASHES = ("-", "--", "-.", ":")


def bound(simulated: dict[str, list[float]]) -> Figure:
    """Depth error against depth: bounds as lines, noisy images as dots."""
    camera, depths = Camera(), torch.logspace(2.55, 3.4, 300, dtype=torch.float64)
    figure, ax = plt.subplots(figsize=(7, 4.2), layout="constrained")
    for name, line, colour in (
        ("defocus", defocus_bound(camera, depths), DEFOCUS),
        (f"stereo, {BASELINE:g} mm", stereo_bound(camera, depths), STEREO),
    ):
        ax.plot(depths, line, color=colour, label=f"{name}: bound")
        ax.plot(DEPTHS, simulated[name.split(",")[0]], "o", color=colour, label=f"{name}: noisy images")
    ax.axvline(camera.focus, color="0.7", linewidth=0.8, linestyle=":")
    ax.text(camera.focus, 0.95, " in focus", color="0.4", transform=ax.get_xaxis_transform())
    ax.set(xscale="log", yscale="log", xlabel="depth Z (mm)", ylabel="depth error (mm)", ylim=(0.03, 1000))
    ax.set_xticks([400, 600, 800, 1000, 1500, 2000], ["400", "600", "800", "1000", "1500", "2000"], minor=False)
    ax.minorticks_off()
    ax.legend(frameon=False, fontsize=8, loc="center right", bbox_to_anchor=(1, 0.52))
    return figure


def phone() -> Figure:
    """Depth error against depth of the phone's cameras, a panel for each light, dashes for f-numbers; lines end where lost."""
    depths = torch.logspace(2.3, 3.7, 600, dtype=torch.float64)
    figure, panels = plt.subplots(1, len(LIGHTS), figsize=(11, 4), sharey=True, layout="constrained")
    for ax, (name, lux) in zip(panels, LIGHTS.items(), strict=True):
        for f_number, dashes in zip(F_NUMBERS, DASHES, strict=True):
            for errors, colour in zip(phone_errors(lux, f_number, depths), (STEREO, DEFOCUS), strict=True):
                ax.plot(depths, errors.where(errors.isfinite(), torch.nan), dashes, color=colour, linewidth=1.2)
        ax.axvline(FOCUS, color="0.7", linewidth=0.8, linestyle=":")
        ax.set(xscale="log", yscale="log", title=f"{name}, {lux:g} lux", xlabel="depth Z (mm)", ylim=(0.02, 1000))
        ax.set_xticks([200, 500, 1000, 2000, 5000], ["200", "500", "1000", "2000", "5000"], minor=False)
        ax.minorticks_off()
    panels[0].set_ylabel("depth error (mm)")
    lines = [plt.Line2D([], [], color=c) for c in (STEREO, DEFOCUS)]
    lines += [plt.Line2D([], [], color="0.5", linestyle=dashes) for dashes in DASHES]
    names = [f"stereo, {BASELINE:g} mm", "defocus", *(f"f/{f_number:g}" for f_number in F_NUMBERS)]
    panels[0].legend(lines, names, frameon=False, fontsize=8, ncols=2, loc="upper left")
    return figure
