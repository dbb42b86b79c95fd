"""Ask every question of the study, write the tables and draw the figure.

python experiments/least_lenses/run.py
"""

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from questions import COUNTS, GOAL, counted, smallest_apertures, smallest_islands, within_tolerance

from multilens.inverse.answer import Answer
from multilens.plot.figures import save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"

FOUND, PROVED = "#0072b2", "#8c8c8c"


def counts_table(answer: Answer) -> list[list]:
    head = ["lenses", "RMSE found (mm)", "no layout is below (mm)"]
    return [head, *([int(trial.value), trial.figure, trial.bound] for trial in answer.trials)]


def least_table(islands: dict[int, Answer], apertures: dict[int, Answer]) -> list[list]:
    head = ["lenses", "size: enough", "outline (mm)", "size: proved too small", "aperture radius: enough (mm)"]
    rows = [[*head, "f-number", "aperture radius: proved too small (mm)"]]
    for count in COUNTS:
        size, radius = islands[count], apertures[count]
        rows.append([count, size.value, _outline(size), size.proved_below])
        rows[-1] += [radius.value, None if radius.value is None else 6.86 / (2 * radius.value), radius.proved_below]
    return rows


def _outline(size: Answer) -> str | None:
    return None if size.value is None else size.resource.words(size.value).split(": ")[1].split(",")[0]


def tolerance_table(answers: dict) -> list[list]:
    rows: list[list] = [
        ["tolerance at every depth", "fewest lenses", "proved too few", "largest error / tolerance, by lenses"]
    ]
    for tolerance, answer in answers.items():
        count, few = (None if number is None else int(number) for number in (answer.value, answer.proved_below))
        figures = ", ".join("-" if trial.figure is None else f"{trial.figure:.3g}" for trial in answer.trials)
        rows.append([str(tolerance), count, few, figures])
    return rows


def figure(counts: list[list], least: list[list]) -> Figure:
    """Draw what so many lenses reach, and how little of the island and of the aperture is enough for the goal."""
    with style():
        drawn = Figure(figsize=(12.0, 4.6), layout="constrained")
        reach, size, radius = drawn.subplots(1, 3)
        number, found, bound = zip(*counts[1:], strict=True)
        reach.plot(number, found, "o-", color=FOUND, label="found")
        reach.plot(number, bound, "_", color=PROVED, markersize=14, markeredgewidth=2, label="no layout is below")
        reach.set(yscale="log", xlabel="lenses", ylabel="RMSE (mm)", title="How few lenses?")
        reach.axhline(
            GOAL, color="#1a1a1a", linestyle=(0, (5, 3)), linewidth=1.0, label=f"goal of the others, {GOAL:g} mm"
        )
        number, enough, little = ([row[column] for row in least[1:]] for column in (0, 1, 3))
        _bars(size, number, enough, little)
        size.set(ylabel="size of the island (1: as it is)", title=f"How small an island for {GOAL:g} mm?")
        enough, little = ([row[column] for row in least[1:]] for column in (4, 6))
        _bars(radius, number, enough, little)
        radius.set(ylabel="aperture radius (mm)", title=f"How narrow an aperture for {GOAL:g} mm?")
        for axes in (reach, size, radius):
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
            axes.legend(frameon=False)
        reach.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0)))
        reach.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        reach.yaxis.set_minor_formatter(NullFormatter())
    return drawn


def _bars(axes, number: list[int], enough: list[float], little: list[float]) -> None:
    """Draw what is proved to be too little as a bar from 0, what is enough as a dot, and what is not known between them."""
    axes.bar(number, little, width=0.5, color=PROVED, alpha=0.6, label="proved too little")
    axes.vlines(number, little, enough, color=FOUND, linewidth=1.5, linestyle=(0, (2, 2)), label="not known")
    axes.plot(number, enough, "o", color=FOUND, label="enough")
    axes.set(xlabel="lenses", ylim=(0, 1.35 * max(enough)))


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    answer, islands, apertures, within = counted(), smallest_islands(), smallest_apertures(), within_tolerance()
    for each in (answer, *islands.values(), *apertures.values(), *within.values()):
        print(each, end="\n\n", flush=True)
    tables = {
        "counts": counts_table(answer),
        "least": least_table(islands, apertures),
        "tolerances": tolerance_table(within),
    }
    for name, table in tables.items():
        write_whole(RESULTS / f"{name}.csv", csv_text(table))
        write_whole(RESULTS / f"{name}.md", markdown_text(table))
    for kind, answers in (("size", islands), ("aperture", apertures)):
        for count, each in answers.items():
            assert each.design is not None
            each.design.save(RESULTS / f"{kind}_{count}.json")
    save_figures({"least": figure(tables["counts"], tables["least"])}, RESULTS)


if __name__ == "__main__":
    main()
