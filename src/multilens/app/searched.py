"""The design that a composed configuration asks for, and what is logged of the search."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from multilens.app import build
from multilens.app.schema import Config
from multilens.app.search import NothingFoundError, search
from multilens.app.tolerance import build_tolerance

if TYPE_CHECKING:
    from multilens.design import Design


@dataclass(frozen=True)
class Searched:
    """What a search found.

    Args:
        design: feasible.
        log: lines on how the search went; the same for the same search.
        seconds: that it took.
    """

    design: "Design"
    log: tuple[str, ...]
    seconds: float


def searched(config: Config, visible: bool) -> Searched:
    """Search as a configuration says; torch is loaded.

    Args:
        config: what is asked.
        visible: whether progress is shown, where there is a terminal.

    Raises:
        RefusedError: it cannot be run.
        NothingFoundError: nothing feasible was found, or no start stayed healthy.
    """
    # It brings torch, which a sweep does not need before it has a job to compute, and which no signal may cut short.
    from multilens.app.terminal import progress_bar

    build.check(config)
    problem, began, stages = build.build_question(config), monotonic(), []
    with progress_bar(stages, visible) as listener:
        found = search(problem, config, listener)
    design, seconds = replace(found, tolerance=build_tolerance(config.tolerance)), monotonic() - began
    if not design.feasible:
        raise NothingFoundError(design.reason)
    return Searched(design, (*stages, design.status, str(design)), seconds)


def log_text(overrides: Sequence[str], *lines: str) -> str:
    """Give the text of a log that begins with the command; empty lines are left out."""
    return "\n".join(filter(None, [" ".join(["multilens", *overrides]), *lines])) + "\n"


def from_here(path: Path) -> Path:
    """Give a path relative to where we are, if it is below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path
