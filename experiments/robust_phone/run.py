"""Search a design for the device as it is drawn and one against each disturbance; try all on devices that none has seen.

python experiments/robust_phone/run.py
"""

from pathlib import Path
from time import process_time

import torch
from cases import CASES, SEARCH, Case, asked
from matplotlib.figure import Figure

import multilens as ml
from multilens.plot.figures import overview_figure, save_figures
from multilens.plot.style import FAINT, LENS_COLOURS, style
from multilens.question import Question
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"


def searched(question: Question) -> tuple[ml.Design, float]:
    """Give the design and the time of the processor that its search took, s."""
    began = process_time()
    design = ml.solve(question, **SEARCH)
    return design, process_time() - began


def row(case: Case, nominal: ml.Design, robust: ml.Design, times: tuple[float, float]) -> dict[str, str]:
    """Give one line of the table."""
    others = case.others()
    figure = others.metric.figure
    before, after = (figure(others.score(design.layout).item()) for design in (nominal, robust))
    return {
        "disturbance": case.title,
        "nominal design (mm)": f"{before:.3f}",
        "robust design (mm)": f"{after:.3f}",
        "change": f"{100 * (after / before - 1):+.0f} %",
        "robust, on its own devices (mm)": f"{robust.figure:.3f}",
        "nominal, as drawn (mm)": f"{_as_drawn(robust, nominal.layout):.3f}",
        "robust, as drawn (mm)": f"{_as_drawn(robust, robust.layout):.3f}",
        "foci (m)": " ".join(f"{focus / 1000:.2f}" for focus in sorted(robust.layout.focus.flatten().tolist())),
        "aperture radii (mm)": " ".join(f"{radius:.2f}" for radius in robust.layout.aperture_radius.tolist()),
        "longest baseline (mm)": f"{torch.pdist(robust.layout.position).max().item():.2f}",
        "search, nominal = 1": f"{times[1] / times[0]:.1f}",
    }


def _as_drawn(robust: ml.Design, layout: ml.Layout) -> float:
    """Give the RMSE of a device that is as drawn but has drifted as the disturbance says."""
    assert isinstance(robust.problem, ml.Robust)
    return robust.problem.drawn.score(layout).item() ** 0.5


def devices_figure(designs: dict[str, ml.Design]) -> Figure:
    """Draw for each disturbance which share of devices and uses is better than an error, of the nominal and the robust design."""
    with style():
        figure = Figure(figsize=(13.333, 4.2), layout="constrained")
        for ax, case in zip(figure.subplots(1, len(CASES)), CASES, strict=True):
            others = case.others()
            for name, colour in (("nominal", FAINT), (case.name, LENS_COLOURS[0])):
                scores, probability = others.outcomes(designs[name].layout)
                error, order = scores.sqrt().sort()
                share = probability[order].cumsum(0)
                label = "nominal design" if name == "nominal" else "robust design"
                ax.step(error, share, where="post", color=colour, linewidth=2, label=label)
            ax.set_title(case.title)
            ax.set_xlabel("RMSE of a device (mm)")
            ax.set_ylim(0, 1)
            ax.grid(True, color="#ececec")
        figure.axes[0].set_ylabel("share of devices and uses that are better")
        figure.axes[0].legend(frameon=False, loc="lower right")
    return figure


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    torch.set_num_threads(1)
    nominal, usual = searched(asked())
    designs, rows = {"nominal": nominal}, []
    for case in CASES:
        design, taken = searched(case.question())
        print(case.title, design, f"{taken:.1f} s of {usual:.1f} s", design.sensitivity(), sep="\n", end="\n\n")
        designs[case.name] = design
        rows.append(row(case, nominal, design, (usual, taken)))
    for name, design in designs.items():
        design.save(RESULTS / f"{name}.json")
    write_whole(RESULTS / "sensitivity.txt", f"{nominal.sensitivity()}\n")
    table = [list(rows[0]), *(list(row.values()) for row in rows)]
    write_whole(RESULTS / "table.csv", csv_text(table))
    write_whole(RESULTS / "table.md", markdown_text(table))
    figures = {"devices": devices_figure(designs)}
    figures |= {name: overview_figure(designs[name].problem, designs[name].layout) for name in ("nominal", "finger")}
    save_figures(figures, RESULTS)


if __name__ == "__main__":
    main()
