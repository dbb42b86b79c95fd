"""What each idea of the search is worth: the same search without it, on the same problems in the same time.

python -m benchmark.ablation
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from math import nan
from pathlib import Path
from statistics import median
from time import monotonic
from typing import Any
from unittest.mock import patch

import multilens as ml
from benchmark.best_known import load
from benchmark.problems import CASES, Case
from multilens.search.foci import Foci
from multilens.search.progress import Progress
from multilens.search.promise import Promise
from multilens.storage import write_whole
from multilens.table_text import markdown_text

RESULTS = Path(__file__).parent / "results" / "ablation.md"

PROBLEMS = (
    "3 blob, mixed",
    "4 phone",
    "6 L, mixed",
    "6 island, mixed",
    "8 rectangle",
    "8 blob",
    "12 disc",
    "12 phone, mixed",
)
SEEDS = (0, 1)
LIMIT = 3.0
"""s, of every run."""

MANY = 1000
"""Fresh starts that no run gets to the end of."""

Without = Callable[[], AbstractContextManager[Any]]


def unchanged(_: object, share: Any, *others: Any, **more: Any) -> Any:
    """Give foci as they are, in place of a method that improves them."""
    return share


def without_shared_out(self: Foci, share: Any) -> Any:
    """Give foci one by one alone."""
    return self._one_by_one(share, afresh=True)


def as_good_as_any(_: object, gain: Any, width: Any) -> Any:
    """Give the same promise for every packing."""
    return 0 * width


IDEAS: dict[str, tuple[Without, dict[str, Any]]] = {
    "everything": (nullcontext, {}),
    "without first layouts": (lambda: patch("multilens.search.solve.first_layouts", lambda *_: iter(())), {}),
    "without packings": (lambda: patch("multilens.search.first.packed", lambda *_: iter(())), {}),
    "without what packings promise": (lambda: patch.object(Promise, "__call__", as_good_as_any), {}),
    "without a better order along the depths": (lambda: patch.object(Foci, "rearranged", unchanged), {}),
    "without parting overlapping starts": (
        lambda: patch("multilens.search.solve.part", lambda variables, price, share: share),
        {},
    ),
    "without sharing out foci at the start": (lambda: patch.object(Foci, "afresh", without_shared_out), {}),
    "without better foci for variations": (lambda: patch.object(Foci, "improved", unchanged), {}),
    "without a last look at the foci of the best": (lambda: patch.object(Foci, "best_for", unchanged), {}),
    "without variations, fresh starts alone": (nullcontext, {"starts": MANY}),
}
"""What is left out, how, and the arguments of `solve` that go with it."""


def main() -> None:
    """Run every variant on every problem, write the table and print it."""
    known = load()
    cases = [case for case in CASES if case.name in PROBLEMS]
    for case in cases:
        ml.solve(case.problem, starts=2, patience=0, proof=0)
    rows: list[list[Any]] = [["search", *(case.name for case in cases), "median"]]
    for idea, (without, arguments) in IDEAS.items():
        with without():
            excess = [
                median(_excess(case, seed, known[case.name].score, arguments) for seed in SEEDS) for case in cases
            ]
        rows.append([idea, *(f"{100 * each:.3f}" for each in excess), f"{100 * median(excess):.3f}"])
    text = (
        "# What each idea of the search is worth\n\n"
        f"Score above the best known after {LIMIT:g} s, in per cent; median of the seeds {', '.join(map(str, SEEDS))}.\n\n"
    )
    write_whole(RESULTS, text + markdown_text(rows))
    print(text + markdown_text(rows))


def _excess(case: Case, seed: int, best: float, arguments: dict[str, Any]) -> float:
    """Give by how much a run is above the best known score when its time is up, as a part of it."""
    began, reached = monotonic(), nan

    def listen(progress: Progress) -> None:
        nonlocal reached
        if progress.layout is not None and monotonic() - began <= LIMIT:
            reached = progress.best

    design = ml.solve(case.problem, seed=seed, time_limit=LIMIT, proof=0, listener=listen, **arguments)
    return (design.score if reached != reached else reached) / best - 1


if __name__ == "__main__":
    main()
