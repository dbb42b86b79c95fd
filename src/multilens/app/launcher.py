"""Launchers that hand jobs to other processes: what they need, what a file must not have them run, and how they fail."""

import shutil
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from typing import Any

from multilens.app.refusal import RefusedError, one_line

SETUP = "setup"
"""Commands that a node runs before a job."""


def refuse_foreign_commands(launcher: Mapping[str, Any], lines: Sequence[str]) -> None:
    """Refuse what would have a shell run something, unless whoever starts the sweep has written it.

    Args:
        launcher: Hydra's part of the configuration, resolved.
        lines: key=value, as they stand on the command line.

    Raises:
        RefusedError: commands stand in a file, or a value has several lines, each of which a shell would read.
    """
    if launcher.get(SETUP) and not any(line.lstrip("+").startswith(f"hydra.launcher.{SETUP}=") for line in lines):
        raise RefusedError(
            f"hydra.launcher.{SETUP} runs commands: it must be given on the command line, got it in a file"
        )
    for name, value in launcher.items():
        if name != SETUP and any("\n" in text for text in _texts(value)):
            raise RefusedError(one_line(f"hydra.launcher.{name} must be on one line, got {value!r}"))


def refuse_without_workers(launcher: Mapping[str, Any]) -> None:
    """Refuse a sweep on no core at all, and jobs for Slurm where it cannot be reached."""
    if launcher.get("n_jobs") == 0:
        raise RefusedError("hydra.launcher.n_jobs must be at least 1, or -1 for one on each core, got 0")
    if launcher["_target_"].endswith(".SlurmLauncher") and shutil.which("srun") is None:
        raise RefusedError(
            "hydra/launcher=submitit_slurm must be started where Slurm's commands are, found no srun on the search path"
        )


@contextmanager
def failures_told() -> Iterator[None]:
    """Turn into an OSError of one line: a node lacks a library, a worker or a job was killed, a job is not taken."""
    try:
        yield
    except ImportError as error:
        raise OSError(one_line(f"{type(error).__name__}: {error}")) from None
    except BrokenExecutor:
        raise OSError(
            "a worker was killed, perhaps for want of memory: the same command goes on where this one stopped"
        ) from None
    except RuntimeError as error:
        if not type(error).__module__.startswith("submitit."):
            raise
        lines = [line for line in str(error).splitlines() if line.strip("- ")]
        raise OSError(one_line(f"{lines[0]}: {lines[-1]}" if lines else type(error).__name__)) from None


def _texts(node: Any) -> Iterator[str]:
    if isinstance(node, Mapping):
        for name, child in node.items():
            yield str(name)
            yield from _texts(child)
    elif isinstance(node, list | tuple):
        for child in node:
            yield from _texts(child)
    else:
        yield str(node)
