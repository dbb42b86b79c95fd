"""A sweep that is killed at random moments and run again each time: what is left, what is computed twice, what differs.

    python -m benchmark.kills

runs a sweep of 24 jobs undisturbed, then once more with 20 kills, and prints the figures. Exit code 1: something was lost.
"""

import argparse
import json
import random
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep

SWEEP = (
    "experiment=phone_back",
    "depth.count=24",
    "search.starts=4",
    "search.patience=0",
    "search.proof=10",
    "lenses.count=range(1,5)",
    "back.outline.width=72,77,82",
    "search.seed=0,1",
)
MAIN = "from multilens.app import main; main()"
TIMED = ("table.csv", "table.jsonl", "table.md")

END = 6.0
"""How much of the kills comes after the last job, while jobs agree and pictures are drawn: as much as for so many jobs."""

BEFORE = "before the last job was finished"
AFTER = "while jobs agreed or pictures were drawn"

BETWEEN_LOOKS = 0.02
"""s, after which is looked again how many jobs are finished."""


@dataclass(frozen=True)
class Outcome:
    """What came of a sweep that was killed.

    Args:
        jobs: how many there are.
        during: how many kills came while what was going on.
        computed_again: jobs that were finished before a kill, and whose time is another one now.
        different: files that are not those of the undisturbed sweep.
        seconds: from the first start to the end.
    """

    jobs: int
    during: dict[str, int]
    computed_again: tuple[str, ...]
    different: tuple[str, ...]
    seconds: float

    def __str__(self) -> str:
        during = ", ".join(f"{count} {what}" for what, count in sorted(self.during.items()))
        return (
            f"{self.jobs} jobs, {sum(self.during.values())} kills: {during}\n"
            f"finished jobs that were computed again: {len(self.computed_again)} {' '.join(self.computed_again)}\n"
            f"files that differ from an undisturbed sweep's: {len(self.different)} {' '.join(self.different)}\n"
            f"from the first start to the end: {self.seconds:.0f} s"
        )


def killed_sweep(folder: Path, kills: int, seed: int, sweep: Sequence[str] = SWEEP) -> Outcome:
    """Run a sweep undisturbed, then in the same place with kills, and say what came of it.

    Args:
        folder: an empty one.
        kills: how many; each in a stretch of its own of the work, which are equally long.
        seed: of the moments in their stretches.
        sweep: words of the command line, without -m and the folder.
    """
    place, undisturbed = folder / "sweep", folder / "undisturbed"
    command = [sys.executable, "-c", MAIN, "-m", *sweep, f"hydra.sweep.dir={place}"]
    pace = _pace(command, place)
    place.rename(undisturbed)
    draw, during, times, began = random.Random(seed), Counter[str](), dict[str, str](), monotonic()
    for stretch in range(kills):
        moment = (stretch + draw.random()) / kills * (pace.jobs + END)
        during[_killed(command, place, moment, pace, draw)] += 1
        times = _times(place) | times
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    seconds, now = monotonic() - began, _times(place)
    again = tuple(sorted(job for job, time in times.items() if now.get(job) != time))
    return Outcome(len(now), dict(during), again, _different(place, undisturbed), seconds)


@dataclass(frozen=True)
class _Pace:
    """How long an undisturbed sweep takes: to its first finished job, for one job, and from the last job to the end; s."""

    jobs: int
    start: float
    job: float
    end: float


def _pace(command: Sequence[str], place: Path) -> _Pace:
    began, moments = monotonic(), list[float]()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None:
            moments += [monotonic() - began] * (_finished(place) - len(moments))
            sleep(BETWEEN_LOOKS)
    assert process.returncode == 0
    ended, (first, last) = monotonic() - began, (moments[0], moments[-1])
    return _Pace(len(moments), first, (last - first) / (len(moments) - 1), ended - last)


def _killed(command: Sequence[str], place: Path, moment: float, pace: _Pace, draw: random.Random) -> str:
    """Run a sweep, kill it at a moment of its work, and say what it was doing.

    Args:
        command: of the sweep.
        place: its folder.
        moment: from 0 to the number of jobs, so many of them are finished and the next one in part; from there to `END` more, the
            same part of what comes after the jobs is over.
        pace: how long all that takes.
        draw: of moments before anything new is finished.
    """
    finished = min(int(moment), pace.jobs)
    part = (moment - finished) * (pace.job if finished < pace.jobs else pace.end / END)
    # What was finished before the last kill is there at once: the start is as good a moment then.
    after = part if _finished(place) < finished else part + draw.uniform(0, pace.start)
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None and _finished(place) < finished:
            sleep(BETWEEN_LOOKS)
        try:
            process.wait(after)
        except subprocess.TimeoutExpired:
            process.kill()
    if process.returncode == 0:
        return "after the end"
    return BEFORE if _finished(place) < pace.jobs else AFTER


def _finished(place: Path) -> int:
    return sum(1 for row in place.glob("*/row.json") if row.parent.name.isdigit())


def _times(place: Path) -> dict[str, str]:
    """Give the times of the finished jobs, as they are written."""
    done = [row.parent for row in place.glob("*/row.json") if row.parent.name.isdigit()]
    return {job.name: (job / "time.json").read_text() for job in done}


def _different(place: Path, undisturbed: Path) -> tuple[str, ...]:
    one, other = _contents(place), _contents(undisturbed)
    return tuple(sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name)))


def _contents(folder: Path) -> dict[str, object]:
    """Give every file but the locks, which are empty, and the times; the tables without the times."""
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    rows = [json.loads(line) for line in (folder / "table.jsonl").read_text(encoding="utf-8").splitlines()]
    return {
        name: path.read_bytes()
        for name, path in files.items()
        if path.suffix != ".lock" and path.name != "time.json" and name not in TIMED
    } | {"tables": [{key: value for key, value in row.items() if key != "time_s"} for row in rows]}


def main() -> None:
    """Run it, print the figures, and leave with exit code 1 if anything was lost."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        outcome = killed_sweep(Path(folder), given.kills, given.seed)
    print(outcome)
    sys.exit(1 if outcome.computed_again or outcome.different else 0)


if __name__ == "__main__":
    main()
