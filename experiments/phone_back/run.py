"""Search every layout of the study, save it, draw it and write the table.

python experiments/phone_back/run.py
"""

from pathlib import Path

import torch
from layouts import CASES, Case

import multilens as ml
from multilens.geometry.pairs import pair_distance
from multilens.plot.figures import overview_figure, save_figures
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"


def row(case: Case, design: ml.Design) -> dict[str, str]:
    """Give a design's line of the table."""
    problem = design.problem
    assert isinstance(problem, ml.Problem)
    winners = problem.winners(design.layout)
    stereo = torch.tensor([m.cue == "stereo" for m in problem.measurements])[winners]
    error = problem.errors(design.layout).amin(-2)
    at = {depth: error[(problem.depths - depth).abs().argmin()].item() for depth in (500.0, 1000.0, 5000.0)}
    return {
        "layout": case.title,
        "lenses": str(case.count),
        "RMSE (mm)": f"{design.rmse:.4f}",
        "gap to the bound (of the score)": f"{100 * design.gap:.2g} %",
        "longest baseline (mm)": f"{pair_distance(design.layout.position).max().item():.2f}",
        "aperture radii (mm)": " ".join(f"{radius:.2f}" for radius in design.layout.aperture_radius.tolist()),
        "foci (m)": " ".join(f"{focus / 1000:.2f}" for focus in sorted(design.layout.focus.flatten().tolist())),
        "depths won by stereo": f"{100 * stereo.double().mean().item():.0f} %",
        "error at 0.5 m (mm)": f"{at[500.0]:.3f}",
        "error at 1 m (mm)": f"{at[1000.0]:.3f}",
        "error at 5 m (mm)": f"{at[5000.0]:.3f}",
    }


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    rows = []
    for case in CASES:
        design = case.design()
        print(case.title, design, sep="\n", end="\n\n")
        design.save(RESULTS / f"{case.name}.json")
        assert isinstance(design.problem, ml.Problem)
        figure = overview_figure(design.problem, design.layout)
        save_figures({case.name: figure}, RESULTS)
        rows.append(row(case, design))
    table = [list(rows[0]), *(list(row.values()) for row in rows)]
    write_whole(RESULTS / "table.csv", csv_text(table))
    write_whole(RESULTS / "table.md", markdown_text(table))


if __name__ == "__main__":
    main()
