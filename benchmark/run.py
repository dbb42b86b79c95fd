"""Run the benchmark and write its tables, curves and best-known file.

python -m benchmark.run
python -m benchmark.run --quick
python -m benchmark.run --only "4 disc" "8 blob"
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from math import inf
from pathlib import Path
from time import monotonic

import multilens as ml
from benchmark.best_known import Entry, improved, load, save
from benchmark.cues import cues_table
from benchmark.curves import curves
from benchmark.growth import growth_table
from benchmark.lanes import CORES, Lanes, warm_lanes
from benchmark.measures import TIE, VERY_CLOSE, Run, is_settled, median_of, stopped_too_early, time_to
from benchmark.methods import OURS, PEERS, RIVAL
from benchmark.problems import CASES, Case
from benchmark.report import Bound, Results, aimed_ratio, summary, table
from benchmark.speed import BATCHES, QUICK_BATCHES, speed_table
from multilens.plot.figures import save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

LIMIT, QUICK_LIMIT = 10.0, 3.0
"""s, of every run, at least."""

MARGIN = 0.05
"""By which the rival may take longer than the aim asks, so that its limit is not itself the answer."""

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
        runs, known = _everything(lanes, chosen, seeds, limit)
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


def _everything(
    lanes: Lanes, cases: Sequence[Case], seeds: Sequence[int], limit: float
) -> tuple[list[Run], dict[str, Entry]]:
    """Give all runs, and what is known with them."""
    known = load()
    with ThreadPoolExecutor(CORES) as threads:
        # Two problems at a time: while one waits for its last run, the other has the core.
        each = threads.map(lambda case: _runs(lanes, case, seeds, limit, known.get(case.name)), cases)
        runs = [run for some in each for run in some]
    known = _with(known, cases, runs)
    while again := [at for at, run in enumerate(runs) if stopped_too_early(run, known[run.case].score)]:
        waiting = {
            at: _begun(lanes, runs[at].case, runs[at].method, runs[at].seed, runs[at].limit, 0.0) for at in again
        }
        runs = [waiting[at]() if at in waiting else run for at, run in enumerate(runs)]
        known = _with(known, cases, runs)
    return runs, known


def _with(known: Mapping[str, Entry], cases: Sequence[Case], runs: Sequence[Run]) -> dict[str, Entry]:
    known = dict(known)
    for case in cases:
        known = improved(
            known, case, [(run.method, each) for run in runs if run.case == case.name for each in run.found]
        )
    return known


def _runs(lanes: Lanes, case: Case, seeds: Sequence[int], limit: float, known: Entry | None) -> list[Run]:
    goal = known.score * (1 + TIE / 2) if known else 0.0

    def begin(name: str, some: Sequence[int], limit: float = limit) -> list[Callable[[], Run]]:
        return [_begun(lanes, case.name, name, seed, limit, goal) for seed in some]

    ours, others = begin(OURS, seeds), [begin(name, seeds[:1]) for name in PEERS if name != RIVAL]
    runs = [run() for run in ours]
    longer = _time_of_the_rival(case, runs, limit, known)
    # Once most of the rival's runs have missed their longer limit its time is known to be beyond.
    most = len(seeds) // 2 + 1
    theirs = [run() for run in begin(RIVAL, seeds[:most], longer)]
    target = _target(runs, known)
    missed = is_settled([time_to(run, target) for run in theirs], len(seeds))
    last = begin(RIVAL, seeds[most:], limit if missed else longer)
    return [*runs, *theirs, *(run() for run in last), *(run() for some in others for run in some)]


def _begun(lanes: Lanes, case: str, name: str, seed: int, limit: float, goal: float) -> Callable[[], Run]:
    """Have a run begin when a core is free, and give what waits for it."""
    wait = lanes.run(name, case, seed, limit, goal)

    def run() -> Run:
        outcome = wait()
        done = Run(case, name, seed, limit, outcome.seconds, tuple(outcome.judged), outcome.failure)
        _tell(done)
        return done

    return run


def _time_of_the_rival(case: Case, ours: Sequence[Run], limit: float, known: Entry | None) -> float:
    """Give how long the rival may go on: until its time shows whether the search is as many times faster as it shall be."""
    target = _target(ours, known)
    needed = median_of([time_to(run, target) for run in ours])
    return max(limit, (1 + MARGIN) * aimed_ratio(case) * needed) if needed < inf else limit


def _target(runs: Sequence[Run], known: Entry | None) -> float:
    """Give the score within 0.1 % of the best that is known by now, mm^2."""
    scores = [each.score for run in runs for each in run.found] + ([known.score] if known else [])
    return min(scores, default=inf) * (1 + VERY_CLOSE)


def _bound(case: str, best: float) -> Bound:
    problem = next(one for one in CASES if one.name == case).problem
    began = monotonic()
    bound = ml.lower_bound(problem, target=best)
    return Bound(bound.value, bound.reason, monotonic() - began)


def _tell(run: Run) -> None:
    last = f"{run.found[-1].score:.7g} mm^2 at {run.found[-1].seconds:.2f} s" if run.found else "nothing"
    # In one piece, for two threads tell.
    line = f"{run.case:22} {run.method:24} seed {run.seed}: {last}, took {run.seconds:.2f} s {run.failure}\n"
    print(line, end="", flush=True)


def _names() -> list[str]:
    return [case.name for case in CASES]


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Run the benchmark.")
    parser.add_argument("--quick", action="store_true", help="three problems, one seed, 3 s a run: about a minute")
    parser.add_argument("--only", nargs="+", choices=_names(), help="these problems alone", metavar="PROBLEM")
    return parser.parse_args()


if __name__ == "__main__":
    main()
