"""The best layouts that anybody's run has found: a file that only improves."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmark.problems import Case, fingerprint
from benchmark.referee import Judged
from multilens.storage import write_whole

FILE = Path(__file__).parent / "best_known.json"


@dataclass(frozen=True)
class Entry:
    """The best known layout of one problem.

    Args:
        problem: fingerprint of the problem that it answers; an entry of a problem that has changed since is stale.
        score: mm^2.
        found_by: the method that found it first.
        layout: its record.
    """

    problem: str
    score: float
    found_by: str
    layout: Any


def load(path: Path = FILE) -> dict[str, Entry]:
    """Give the entries by the names of the problems; none where there is no file yet."""
    if not path.exists():
        return {}
    return {name: Entry(**fields) for name, fields in json.loads(path.read_text(encoding="utf-8")).items()}


def save(entries: dict[str, Entry], path: Path = FILE) -> None:
    """Write the file whole."""
    text = json.dumps({name: asdict(entry) for name, entry in entries.items()}, indent=1)
    write_whole(path, text + "\n")


def improved(entries: dict[str, Entry], case: Case, found: Iterable[tuple[str, Judged]]) -> dict[str, Entry]:
    """Give the entries with anything better that was found for a problem; a stale entry is replaced by the best of it.

    Args:
        entries: by the names of the problems.
        case: the problem.
        found: layouts that count, each with the method that found it.
    """
    mark = fingerprint(case.problem)
    best = entries.get(case.name)
    best = best if best is not None and best.problem == mark else None
    for method, judged in found:
        if best is None or judged.score < best.score:
            best = Entry(mark, judged.score, method, judged.layout)
    return entries | ({case.name: best} if best else {})
