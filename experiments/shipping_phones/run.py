"""Score every phone as it ships and over plausible spacings, and search the best layout of the same lenses in the same island.

python experiments/shipping_phones/run.py
"""

from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.pyplot as plt
from extend import extension_table
from matplotlib.figure import Figure
from phones import PHONES, SEED, Phone, freed, plausible, spacing, spread
from photometric import photometric_rows

import multilens as ml
from multilens.plot.figures import overview_figure, save_figures
from multilens.plot.style import FAINT, lens_colour, style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"

TICKS = (1, 2, 5, 10, 20, 40)
"""Of the figure, mm."""


@dataclass(frozen=True)
class Found:
    """What came of one phone.

    Args:
        phone: which.
        shipped: at the published or assumed spacing.
        best: the same lenses, searched in the same island.
        ends: RMSE at the least and the largest spacing that is plausible, mm; the shipped one's where it is published.
    """

    phone: Phone
    shipped: ml.Design
    best: ml.Design
    ends: tuple[float, float]


def study(phone: Phone) -> Found:
    """Score one phone and search its island."""
    problem = phone.problem()
    shipped = ml.evaluate(problem, seed=SEED)
    best = ml.solve(freed(problem, phone.island), seed=SEED)
    if phone.published:
        ends = (shipped.rmse, shipped.rmse)
    else:
        least, most = (ml.evaluate(spread(problem, apart), seed=SEED).rmse for apart in plausible(problem))
        ends = (least, most)
    return Found(phone, shipped, best, ends)


def row(found: Found) -> dict[str, str]:
    """Give a phone's line of the table."""
    problem = found.shipped.problem
    assert isinstance(problem, ml.Problem)
    low, high = plausible(problem)
    baseline, best_baseline = (design.longest_baseline for design in (found.shipped, found.best))
    assert baseline is not None
    assert best_baseline is not None
    known = found.phone.published
    return {
        "phone": found.phone.title,
        "lenses": str(len(problem.lenses)),
        "neighbours apart (mm)": f"{spacing(problem):.2f}"
        if known
        else f"{spacing(problem):.0f} ({low:.1f} to {high:.0f})",
        "places": "published" if known else "estimated",
        "RMSE as shipped (mm)": f"{found.shipped.rmse:.2f}"
        + ("" if known else f" ({found.ends[0]:.2f} to {found.ends[1]:.2f})"),
        "widest pair (mm)": f"{baseline[0]:.2f}",
        "RMSE, same lenses in the same island (mm)": f"{found.best.rmse:.2f}",
        "gap to the bound (of the score)": f"{100 * found.best.gap:.2g} %",
        "widest pair there (mm)": f"{best_baseline[0]:.2f}",
        "less by": f"{100 * (1 - found.best.rmse / found.shipped.rmse):.0f} %",
    }


def figure(all_found: list[Found]) -> Figure:
    """Draw the error of every phone: as shipped with its range, and the best in the same island."""
    with style():
        drawn, axes = plt.subplots(figsize=(9, 4.6), layout="constrained")
        for line, found in enumerate(all_found):
            axes.plot(found.ends, (line, line), color=FAINT, linewidth=2, solid_capstyle="butt", zorder=1)
            axes.plot(found.best.rmse, line, "D", color=lens_colour(5), markersize=5, zorder=3)
            axes.plot(found.shipped.rmse, line, "o", color=lens_colour(0), markersize=11, zorder=2)
        axes.plot([], [], "o", color=lens_colour(0), markersize=11, label="as shipped")
        axes.plot([], [], color=FAINT, linewidth=2, label="as shipped, plausible spacings")
        axes.plot([], [], "D", color=lens_colour(5), markersize=5, label="best, same lenses, same island")
        axes.set_yticks(range(len(all_found)), [found.phone.title for found in all_found])
        axes.invert_yaxis()
        axes.set(xlabel="RMSE of depth from 0.2 to 5 m (mm)", xscale="log", xlim=(1, 40))
        axes.set_xticks(TICKS, [str(tick) for tick in TICKS])
        axes.minorticks_off()
        axes.grid(axis="x", color="0.92")
        axes.set_axisbelow(True)
        axes.legend(frameon=False, loc="lower right")
    return drawn


def write_table(name: str, rows: list[dict[str, str]]) -> None:
    """Write rows as CSV and as Markdown."""
    table = [list(rows[0]), *(list(row.values()) for row in rows)]
    write_whole(RESULTS / f"{name}.csv", csv_text(table))
    write_whole(RESULTS / f"{name}.md", markdown_text(table))
    print(markdown_text(table))


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    all_found = []
    for phone in PHONES:
        found = study(phone)
        print(phone.title, found.shipped, found.best, sep="\n", end="\n\n", flush=True)
        found.shipped.save(RESULTS / f"{phone.name}.json")
        # The history of the search is of no use here, and most of the file.
        replace(found.best, convergence=None).save(RESULTS / f"{phone.name}_best.json")
        all_found.append(found)
    write_table("phones", [row(found) for found in all_found])
    save_figures({"phones": figure(all_found)}, RESULTS)
    shown = next(found for found in all_found if found.phone.name == "iphone_15_pro_max")
    for name, design in (("shipped", shown.shipped), ("best", shown.best)):
        assert isinstance(design.problem, ml.Problem)
        save_figures({f"iphone_15_pro_max_{name}": overview_figure(design.problem, design.layout)}, RESULTS)
    write_table("photometric", photometric_rows(RESULTS))
    rows, extended = extension_table(RESULTS)
    write_table("extension", rows)
    save_figures(extended, RESULTS)


if __name__ == "__main__":
    main()
