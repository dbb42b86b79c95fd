"""Search every layout of the study, save it, draw it and write the tables.

python experiments/usable_pairs/run.py
"""

from pathlib import Path

import torch
from cases import CASES, METRICS, SEED, Case, floor, unlike
from figures import nearest_depths, served

import multilens as ml
from multilens.bands import NOTHING, winner_bands
from multilens.coverage import coverage_in_words
from multilens.plot.figures import overview_figure, save_figures
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"


def row(case: Case, design: ml.Design, free: ml.Design) -> dict[str, str]:
    """Give a design's line of the table, beside the best design where pairs never fail."""
    problem = design.problem
    assert isinstance(problem, ml.Problem)
    used = {band.measurement.lenses for band in winner_bands(problem, design.layout) if band.measurement != NOTHING}
    baselines = sorted(torch.dist(*design.layout.position[list(pair)]).item() for pair in used)
    name, unit = problem.metric.name, problem.metric.unit
    return {
        "minimised": f"{name} ({unit})",
        "lenses": str(case.count),
        "with limits": f"{design.figure:.4g}",
        "floor for any number of lenses": f"{floor(case.metric, problem.depths):.4g}",
        "without limits": f"{free.figure:.4g}",
        "depths measured": f"{100 * design.measured:.3g} %",
        "baselines that serve (mm)": " ".join(f"{baseline:.1f}" for baseline in baselines),
    }


def bands(case: Case, design: ml.Design) -> list[dict[str, str]]:
    """Give which pair serves which depths."""
    problem = design.problem
    assert isinstance(problem, ml.Problem)
    found = []
    for band in winner_bands(problem, design.layout):
        if band.measurement == NOTHING:
            continue
        i, j = band.measurement.lenses
        baseline = torch.dist(design.layout.position[i], design.layout.position[j]).item()
        found.append(
            {
                "lenses": str(case.count),
                "from (mm)": f"{band.near:.0f}",
                "to (mm)": f"{band.far:.0f}",
                "pair": f"{i + 1}-{j + 1}",
                "baseline (mm)": f"{baseline:.1f}",
            }
        )
    return found


def write_table(name: str, rows: list[dict[str, str]]) -> None:
    table = [list(rows[0]), *(list(line.values()) for line in rows)]
    write_whole(RESULTS / f"{name}.csv", csv_text(table))
    write_whole(RESULTS / f"{name}.md", markdown_text(table))


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    designs, rows, served_by = {}, [], []
    for case in CASES:
        design = designs[case] = case.design()
        print(case.name, design, sep="\n", end="\n\n", flush=True)
        design.save(RESULTS / f"{case.name}.json")
        rows.append(row(case, design, Case(case.metric, case.count, limited=False).design()))
        served_by += bands(case, design) if case.metric == "relative" else []
    write_table("table", rows)
    write_table("served", served_by)
    three = ml.solve(unlike(), seed=SEED, proof=0)
    print(three)
    three.save(RESULTS / "wide_ultrawide_tele.json")
    assert isinstance(three.problem, ml.Problem)
    parts = [
        {
            "part of the field": f"{100 * part.share:.3g} %",
            "seen by": " ".join(("main", "ultra-wide", "tele")[lens] for lens in part.lenses),
        }
        for part in three.problem.parts
    ]
    write_table("field", parts)
    write_whole(RESULTS / "coverage.txt", coverage_in_words(three.problem, three.layout) + "\n")
    relative = {case.count: design for case, design in designs.items() if case.metric == list(METRICS)[-1]}
    figures = {
        "served": served(relative),
        "nearest": nearest_depths(three.problem),
        "wide_ultrawide_tele": overview_figure(three.problem, three.layout),
    }
    save_figures(figures, RESULTS)


if __name__ == "__main__":
    main()
