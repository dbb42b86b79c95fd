"""What each idea of the search is worth: how long the same search takes without it, on the same problems.

python -m benchmark.ablation

Time is that of the processor, which other work on the machine lengthens less than that on the wall.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from math import inf
from pathlib import Path
from statistics import median
from time import process_time
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
SEEDS = (0, 1, 2, 3, 4)
NEAR = 1e-3
"""Part of the best known score by which a layout may be above it."""
LIMIT = 10.0
"""s, after which a run ends without having come near."""

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
    "without exchanges of unlike lenses": (lambda: patch("multilens.search.packed.EXCHANGES", 0), {}),
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
    rows: list[list[Any]] = [["search", *(case.name for case in cases)]]
    for idea, (without, arguments) in IDEAS.items():
        with without():
            spent = [
                median(_seconds(case, seed, known[case.name].score, arguments) for seed in SEEDS) for case in cases
            ]
        rows.append([idea, *(f"> {LIMIT:g}" if each == inf else f"{each:.2f}" for each in spent)])
    text = (
        "# What each idea of the search is worth\n\n"
        f"Processor seconds of one core until a layout is within {NEAR:.1%} of the best known score; "
        f"median of the seeds {', '.join(map(str, SEEDS))}.\n\n"
    )
    text += markdown_text(rows)
    write_whole(RESULTS, text)
    print(text)


class _NearError(Exception):
    """Ends a run that has come near."""


def _seconds(case: Case, seed: int, best: float, arguments: dict[str, Any]) -> float:
    """Give how long a run takes to come near the best known score, s of the processor; infinite where its time is up before."""
    began = process_time()

    def listen(progress: Progress) -> None:
        if progress.layout is not None and progress.best <= best * (1 + NEAR):
            raise _NearError

    try:
        ml.solve(case.problem, seed=seed, time_limit=LIMIT, proof=0, listener=listen, **arguments)
    except _NearError:
        return process_time() - began
    return inf


if __name__ == "__main__":
    main()
