"""What a sweep costs beside its searches, and what a second worker brings.

    python -m benchmark.sweeps

writes results/sweeps.md. Leave the machine to it: each figure is of two cores that do nothing else.
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
    with tempfile.TemporaryDirectory() as folder:
        cost = overhead(JOBS, Path(folder))
        one, two = (seconds_with(workers, Path(folder) / f"study_{workers}", STUDY) for workers in (1, 2))
        alone, both = (seconds_with(workers, Path(folder) / f"short_{workers}", *SHORT) for workers in (1, 2))
    rows = [
        ["figure", "measured", "target"],
        [
            f"a job of {JOBS} beyond its search, by the clock",
            f"{cost.clock * 1e3:.0f} ms",
            f"<= {MOST_OVERHEAD * 1e3:.0f} ms",
        ],
        ["the same, time of the processor", f"{cost.processor * 1e3:.0f} ms", ""],
        ["its search, by the clock", f"{cost.search * 1e3:.0f} ms", ""],
        ["camera_count, 48 jobs, one worker", f"{one:.1f} s", ""],
        ["camera_count, two workers", f"{two:.1f} s", ""],
        ["two workers against one", f"{one / two:.2f} times", f">= {LEAST_SPEED_UP} times"],
        ["12 jobs of a second, one worker and two", f"{alone:.1f} s, {both:.1f} s", ""],
    ]
    text = f"# Sweeps\n\nOn {os.cpu_count()} cores. `make bench-sweeps` writes this page.\n\n{markdown_text(rows)}"
    print(text)
    RESULT.write_text(text, encoding="utf-8")
    sys.exit(0 if cost.clock <= MOST_OVERHEAD and one / two >= LEAST_SPEED_UP else 1)


if __name__ == "__main__":
    main()
