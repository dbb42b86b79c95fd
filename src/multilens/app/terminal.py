"""What is seen on the terminal while a search runs; nothing where there is no terminal."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from multilens.metrics import in_words
from multilens.search.progress import BOUND, Listener
from multilens.search.progress import Progress as SearchProgress


@contextmanager
def progress_bar(log: list[str], visible: bool) -> Iterator[Listener]:
    """Show a search's progress on stderr, and keep the last word on each stage for the log.

    Args:
        log: lines are added to it: each stage when it ends.
        visible: whether to show anything at all; where stderr is no terminal nothing is shown either.
    """
    console = Console(stderr=True)
    columns = [
        TextColumn("{task.description:<10}"),
        BarColumn(),
        TextColumn("{task.fields[told]}"),
    ]
    last: dict[str, SearchProgress] = {}
    with Progress(*columns, console=console, transient=True, disable=not (visible and sys.stderr.isatty())) as shown:
        bar = shown.add_task("search", total=1.0, told="")

        def listen(progress: SearchProgress) -> None:
            last[progress.stage] = progress
            # Without a total the bar only shows that something goes on.
            total = None if progress.stage == BOUND else 1.0
            shown.update(bar, description=progress.stage, total=total, completed=progress.done, told=told(progress))

        try:
            yield listen
        finally:
            log += [f"{stage}: {how_far(progress)}" for stage, progress in last.items() if stage != BOUND]


def told(progress: SearchProgress) -> str:
    """Say in words how far a search has come, and how long it still takes."""
    left = f", {max(progress.seconds_left, 0):.0f} s left" if isfinite(progress.seconds_left) else ""
    return how_far(progress) + left


def how_far(progress: SearchProgress) -> str:
    """Say in words how far a search has come: starts alive, the best so far."""
    best = in_words(progress.metric, progress.best, 4) if isfinite(progress.best) else "none"
    return f"{progress.alive} of {progress.starts} starts alive, best {best}"
