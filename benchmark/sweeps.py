"""What a sweep costs beside its searches, and what a second worker brings.

    python -m benchmark.sweeps

writes results/sweeps.md. Leave the machine to it: each figure is of two cores that do nothing else. Machines that are rented share
more than they say, and are a third slower at some times than at others, so everything is measured in three rounds; what took least
is compared, and all three are shown.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, process_time
from unittest.mock import patch

from multilens.app.command import run_command
from multilens.table_text import markdown_text

TINY = (
    "experiment=phone_back",
    "depth.count=8",
    "lenses.count=1",
    "search.starts=1",
    "search.patience=0",
    "search.proof=0",
)
JOBS = 200

STUDY = "experiment=camera_count"
"""What a second worker is for: 48 jobs of 1 to 8 s, agreement, and the pictures."""
SHORT = ("experiment=phone_back_island", "search=quick", "lenses.count=5", "search.seed=range(0,12)")
"""A dozen jobs of a second, beside which the start of a worker is long."""
MAIN = "from multilens.app import main; main()"

ROUNDS = 3

MOST_OVERHEAD = 0.050
"""s of a job beyond its search."""

LEAST_SPEED_UP = 1.7

RESULT = Path(__file__).parent / "results" / "sweeps.md"


@dataclass(frozen=True)
class Overhead:
    """What a job of a sweep costs beyond its search, s.

    Args:
        clock: as a clock on the wall tells it.
        processor: time of the processor, which other programs lengthen less.
        search: that the search of one job took, by the clock.
    """

    clock: float
    processor: float
    search: float


def overhead(jobs: int, folder: Path) -> Overhead:
    """Measure it in this process, which has loaded everything before; the tables are part of it, agreement and pictures not.

    Args:
        jobs: how many, one lens each.
        folder: new.
    """
    import multilens.app.searched as module

    spent = [0.0, 0.0]
    search = module.search

    def timed(*given, **named):
        clock, processor = monotonic(), process_time()
        try:
            return search(*given, **named)
        finally:
            spent[0] += monotonic() - clock
            spent[1] += process_time() - processor

    with patch.object(module, "search", timed), patch("multilens.app.sweep.pictures_drawn", lambda *given: True):
        _sweep(2, folder / "first")
        spent[:] = [0.0, 0.0]
        clock, processor = monotonic(), process_time()
        _sweep(jobs, folder / "all")
    lasted, worked = monotonic() - clock, process_time() - processor
    return Overhead((lasted - spent[0]) / jobs, (worked - spent[1]) / jobs, spent[0] / jobs)


def _sweep(jobs: int, folder: Path) -> None:
    words = ["-m", *TINY, f"search.seed=range(0,{jobs})", "sweep.agree=false", f"hydra.sweep.dir={folder}"]
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
        assert run_command(words) == 0


def seconds_with(workers: int, folder: Path, *sweep: str) -> float:
    """Give how long a sweep takes with so many workers, from the command to its end, s."""
    words = ["hydra/launcher=joblib", f"hydra.launcher.n_jobs={workers}", f"hydra.sweep.dir={folder}"]
    command = [sys.executable, "-c", MAIN, "-m", *sweep, *words]
    began = monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return monotonic() - began


def main() -> None:
    """Measure, print and write the figures; exit code 1 where a target is missed."""
    costs, study, short = [], {1: [], 2: []}, {1: [], 2: []}
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as folder:
            costs.append(overhead(JOBS, Path(folder)))
            for workers in (1, 2):
                study[workers].append(seconds_with(workers, Path(folder) / f"study_{workers}", STUDY))
                short[workers].append(seconds_with(workers, Path(folder) / f"short_{workers}", *SHORT))
    clock = min(cost.clock for cost in costs)
    speed_up = min(study[1]) / min(study[2])
    rows = [
        ["figure", "measured", "target"],
        [
            f"a job of {JOBS} beyond its search, by the clock",
            _listed([cost.clock * 1e3 for cost in costs], "ms"),
            f"<= {MOST_OVERHEAD * 1e3:.0f} ms",
        ],
        ["the same, time of the processor", _listed([cost.processor * 1e3 for cost in costs], "ms"), ""],
        ["its search, by the clock", _listed([cost.search * 1e3 for cost in costs], "ms"), ""],
        ["camera_count, 48 jobs, one worker", _listed(study[1], "s"), ""],
        ["camera_count, two workers", _listed(study[2], "s"), ""],
        ["two workers against one, least against least", f"{speed_up:.2f} times", f">= {LEAST_SPEED_UP} times"],
        ["12 jobs of a second, one worker", _listed(short[1], "s"), ""],
        ["12 jobs of a second, two workers", _listed(short[2], "s"), ""],
    ]
    told = f"On {os.cpu_count()} cores, each figure of {ROUNDS} rounds. `make bench-sweeps` writes this page."
    text = f"# Sweeps\n\n{told}\n\n{markdown_text(rows)}"
    print(text)
    RESULT.write_text(text, encoding="utf-8")
    sys.exit(0 if clock <= MOST_OVERHEAD and speed_up >= LEAST_SPEED_UP else 1)


def _listed(measured: list[float], unit: str) -> str:
    """Give all that was measured, in the order of the rounds."""
    return f"{', '.join(f'{one:.3g}' for one in measured)} {unit}"


if __name__ == "__main__":
    main()
