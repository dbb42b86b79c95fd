"""Score the eyes of three families of spiders: each pair alone, all together, and the tiers of a principal eye.

python experiments/spiders/run.py
"""

from itertools import pairwise
from math import isfinite
from pathlib import Path

import matplotlib.pyplot as plt
from families import FAMILIES, PAIRS, RANGES, SEED, Family, pair_of, with_tiers
from matplotlib.figure import Figure

import multilens as ml
from multilens.plot.figures import overview_figure, save_figures
from multilens.plot.style import lens_colour, style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"

TIERS = (1, 2, 3, 4)

TICKS = (0.1, 1, 10, 100)
"""Of the figure, mm."""


def scored(problem: ml.Problem) -> ml.Design:
    """Give the design of a problem whose eyes stand where they do."""
    return ml.evaluate(problem, seed=SEED)


def stereo_share(design: ml.Design) -> float:
    """Give the share of the depths at which stereo is the best."""
    assert isinstance(design.problem, ml.Problem)
    measured = [design.problem.measurements[k].cue for k in design.problem.winners(design.layout).tolist()]
    return measured.count("stereo") / len(measured)


def pair_rows(family: Family) -> list[dict[str, str]]:
    """Give a line for each pair of eyes of a family, and one for all eight."""
    rows = []
    problem = {cues: family.problem(*family.hunts, cues) for cues in ("stereo", "defocus", "stereo_and_defocus")}
    for pair in (*PAIRS, None):
        found = {cues: scored(asked if pair is None else pair_of(asked, pair)) for cues, asked in problem.items()}
        both = found["stereo_and_defocus"]
        baseline = both.longest_baseline
        assert baseline is not None
        widest = max(both.layout.aperture_radius.tolist())
        rows.append(
            {
                "family": family.title,
                "depths (mm)": f"{family.hunts[0]} to {family.hunts[1]}",
                "eyes": pair or "all eight",
                "apart (mm)": f"{baseline[0]:.2f}",
                "widest lens (mm)": f"{2 * widest:.2f}",
                "stereo alone (mm)": f"{found['stereo'].rmse:.3g}",
                "defocus alone (mm)": f"{found['defocus'].rmse:.3g}",
                "both (mm)": f"{both.rmse:.3g}",
                "depths won by stereo": f"{100 * stereo_share(both):.0f} %",
            }
        )
    return rows


def tier_rows() -> list[dict[str, str]]:
    """Give a line for each range of depths: the principal eyes of a jumping spider with one to four tiers, defocus alone."""
    family = FAMILIES[2]
    rows = []
    for near, far in RANGES:
        principal = pair_of(family.problem(near, far, "defocus"), "anterior median")
        one_eye = ml.Problem(principal.back, principal.lenses[:1], principal.depths, cues=principal.cues)
        errors = [scored(with_tiers(one_eye, tiers)).rmse for tiers in TIERS]
        rows.append(
            {"depths (mm)": f"{near} to {far}"}
            | {
                f"{tiers} tier{'s' if tiers > 1 else ''} (mm)": f"{rmse:.3g}"
                for tiers, rmse in zip(TIERS, errors, strict=True)
            }
            | {"each tier divides by": ", ".join(f"{before / after:.2f}" for before, after in pairwise(errors))}
        )
    return rows


def figure(rows: list[dict[str, str]]) -> Figure:
    """Draw the error of every pair of every family, by stereo alone and by defocus alone."""
    with style():
        drawn, panels = plt.subplots(1, len(FAMILIES), figsize=(11, 3.6), sharey=True, layout="constrained")
        for axes, family in zip(panels, FAMILIES, strict=True):
            own = [row for row in rows if row["family"] == family.title]
            for colour, column in ((0, "stereo alone (mm)"), (5, "defocus alone (mm)"), (2, "both (mm)")):
                values = [float(row[column]) for row in own]
                lines = [line for line, value in enumerate(values) if isfinite(value)]
                marker = {0: "o", 5: "D", 2: "x"}[colour]
                label = column.removesuffix(" (mm)")
                axes.plot(
                    [values[i] for i in lines], lines, marker, color=lens_colour(colour), markersize=9, label=label
                )
            axes.set_yticks(range(len(own)), [row["eyes"] for row in own])
            near, far = family.hunts
            axes.set(
                xscale="log", xlim=(0.05, 150), xlabel="RMSE of depth (mm)", title=f"{family.title}, {near} to {far} mm"
            )
            axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
            axes.minorticks_off()
            axes.grid(axis="x", color="0.92")
            axes.set_axisbelow(True)
        panels[0].invert_yaxis()
        panels[-1].legend(frameon=False, loc="best")
    return drawn


def write_table(name: str, rows: list[dict[str, str]]) -> None:
    """Write rows as CSV and as Markdown."""
    table = [list(rows[0]), *(list(row.values()) for row in rows)]
    write_whole(RESULTS / f"{name}.csv", csv_text(table))
    write_whole(RESULTS / f"{name}.md", markdown_text(table))
    print(markdown_text(table), flush=True)


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    rows = [row for family in FAMILIES for row in pair_rows(family)]
    write_table("pairs", rows)
    write_table("tiers", tier_rows())
    save_figures({"pairs": figure(rows)}, RESULTS)
    for family in FAMILIES:
        design = scored(family.problem(*family.hunts))
        design.save(RESULTS / f"{family.name}.json")
        assert isinstance(design.problem, ml.Problem)
        save_figures({family.name: overview_figure(design.problem, design.layout)}, RESULTS)


if __name__ == "__main__":
    main()
