"""Run the benchmark and write its tables, curves and best-known file.

python -m benchmark.run
python -m benchmark.run --quick
python -m benchmark.run --only "4 disc" "8 blob"
"""

import argparse
from pathlib import Path
from time import monotonic

import multilens as ml
from benchmark.best_known import save
from benchmark.cues import cues_table
from benchmark.curves import curves
from benchmark.growth import growth_table
from benchmark.lanes import warm_lanes
from benchmark.problems import CASES
from benchmark.report import Bound, Results, summary, table
from benchmark.schedule import everything
from benchmark.speed import BATCHES, QUICK_BATCHES, speed_table
from multilens.plot.figures import save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

LIMIT, QUICK_LIMIT = 10.0, 3.0
"""s, of every run, at least."""

SEEDS = (0, 1, 2)
"""Fixed before the first run. The peers that are far behind run with the first alone."""

RESULTS = Path(__file__).parent / "results"
QUICK_RESULTS = Path(__file__).parents[1] / "runs" / "benchmark"
"""What is not the whole benchmark goes where runs go, and replaces no result."""


def main() -> None:
    """Run what the command line asks for."""
    options, began = _options(), monotonic()
    chosen = [case for case in CASES if (not options.quick or case.quick) and case.name in (options.only or _names())]
    whole = not options.quick and not options.only
    limit, seeds = (QUICK_LIMIT, SEEDS[:1]) if options.quick else (LIMIT, SEEDS)
    with warm_lanes() as lanes:
        cues = lanes.ask(cues_table) if whole else None
        runs, known = everything(lanes, chosen, seeds, limit)
        save(known)
        asked = {case.name: lanes.ask(_bound, case.name, known[case.name].score) for case in chosen}
        bounds = {name: each.result() for name, each in asked.items()}
        # These come last, one by one, each on a machine that does nothing else.
        batches = QUICK_BATCHES if options.quick else BATCHES
        tables = [lanes.ask(speed_table, ("cpu",), batches).result(), lanes.ask(growth_table).result()]
        results = Results(chosen, runs, known, limit, bounds, *tables, *([cues.result()] if cues else []))
    folder = RESULTS if whole else QUICK_RESULTS
    write(results, folder)
    print(summary(results))
    print(f"written to {folder}, after {(monotonic() - began) / 60:.1f} minutes")


def write(results: Results, folder: Path) -> None:
    """Write the tables, the curves and the summary."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = table(results)
    write_whole(folder / "table.csv", csv_text(rows))
    write_whole(folder / "table.md", markdown_text(rows))
    write_whole(folder / "summary.md", summary(results))
    with style():
        save_figures({"curves": curves(results)}, folder)


def _bound(case: str, best: float) -> Bound:
    problem = next(one for one in CASES if one.name == case).problem
    began = monotonic()
    bound = ml.lower_bound(problem, target=best)
    return Bound(bound.value, bound.reason, monotonic() - began)


def _names() -> list[str]:
    return [case.name for case in CASES]


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Run the benchmark.")
    parser.add_argument("--quick", action="store_true", help="three problems, one seed, 3 s a run: about a minute")
    parser.add_argument("--only", nargs="+", choices=_names(), help="these problems alone", metavar="PROBLEM")
    return parser.parse_args()


if __name__ == "__main__":
    main()
