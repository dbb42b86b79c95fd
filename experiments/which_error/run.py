"""Search every design of the study, judge each by every metric, write the table and draw the errors.

python experiments/which_error/run.py
"""

from pathlib import Path

import torch
from cases import CASES, METRICS, SEED, problem
from matplotlib.figure import Figure

import multilens as ml
from multilens.bands import dense_depths
from multilens.plot.figures import save_figures
from multilens.plot.style import LENS_COLOURS, style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"


def row(metric: str, fusion: str, design: ml.Design) -> list[str]:
    judged = [each.figure(problem(name, fusion).score(design.layout).item()) for name, each in METRICS.items()]
    foci = " ".join(f"{focus:.0f}" for focus in sorted(design.layout.focus.flatten().tolist()))
    gap = "" if design.bound is None or design.bound.value is None else f"{100 * design.gap:.2g} %"
    baseline, _ = design.longest_baseline or (0.0, None)
    return [f"{metric}, {fusion}", *(f"{figure:.4g}" for figure in judged), gap, f"{baseline:.2f}", foci]


def errors(designs: dict[tuple[str, str], ml.Design]) -> Figure:
    """Draw the error of each design in % of the depth, and its foci above."""
    with style():
        figure = Figure(figsize=(9.0, 5.5))
        ax = figure.add_axes((0.09, 0.12, 0.88, 0.78))
        for index, ((metric, fusion), design) in enumerate(designs.items()):
            assert isinstance(design.problem, ml.Problem)
            depths = dense_depths(design.problem, design.layout)
            percent = 100 * design.problem.squared_error(design.layout, depths).sqrt() / depths
            colour = LENS_COLOURS[index % len(LENS_COLOURS)]
            ax.plot(depths / 1000, percent.clamp(min=1e-5), color=colour, linewidth=1.4, label=f"{metric}, {fusion}")
            foci = design.layout.focus.flatten() / 1000
            ax.plot(foci, torch.full_like(foci, 0.2 * 1.12**index), "v", color=colour, markersize=5, clip_on=False)
        ax.set(xscale="log", yscale="log", xlim=(0.2, 5), ylim=(0.002, 0.4))
        ax.set(xlabel="depth (m)", ylabel="depth error (% of the depth)")
        ticks = [0.2, 0.5, 1.0, 2.0, 5.0]
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks], minor=False)
        ax.set_xticks([], minor=True)
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=9)
    return figure


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    designs = {}
    for metric, fusion in CASES:
        design = designs[metric, fusion] = ml.solve(problem(metric, fusion), starts=64, patience=4, seed=SEED)
        print(metric, fusion, design, sep="\n", end="\n\n", flush=True)
        design.save(RESULTS / f"{metric}_{fusion}.json")
    head = ["asked for", *(f"{each.name} ({each.unit})" for each in METRICS.values())]
    table = [
        [*head, "gap", "longest baseline (mm)", "foci (mm)"],
        *(row(*case, design) for case, design in designs.items()),
    ]
    write_whole(RESULTS / "table.csv", csv_text(table))
    write_whole(RESULTS / "table.md", markdown_text(table))
    save_figures({"errors": errors(designs)}, RESULTS)


if __name__ == "__main__":
    main()
