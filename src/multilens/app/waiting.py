"""Jobs that somebody else was computing when their turn came: at the end they are waited for, and computed if he is gone.

waiting-NUMBER.yaml holds what the job is. It vanishes when the job is done.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

from omegaconf import DictConfig, OmegaConf

from multilens.app import build
from multilens.app.plain import plain, yaml_text
from multilens.app.schema import Config
from multilens.storage import write_whole
from multilens.sweeps.locks import forget, held

Compute = Callable[[Config, Path, Sequence[str], bool], bool]
PREFIX = "waiting-"


def leave_waiting(config: Config, folder: Path, overrides: Sequence[str]) -> None:
    """Note that a job is to be looked at once more at the end of the sweep.

    Args:
        config: of the job.
        folder: of the job.
        overrides: words of the command line that make the job.
    """
    name = f"{PREFIX}{folder.name}"
    with held(folder.parent, name):
        write_whole(
            folder.parent / f"{name}.yaml",
            yaml_text({"overrides": list(overrides), "config": plain(config)}),
        )


def finish_waiting(sweep: Path, compute_if_missing: Compute) -> None:
    """Wait for every job that was left to somebody else, and compute it if he ended without an answer.

    Args:
        sweep: folder of the sweep.
        compute_if_missing: called with what the job is, once its lock is held.

    Raises:
        RefusedError, OSError: as `compute_if_missing` does.
    """
    for note in sorted(sweep.glob(f"{PREFIX}*.yaml")):
        number = note.stem.removeprefix(PREFIX)
        with held(sweep, number):
            _finish(note, sweep / number, compute_if_missing)


def _finish(note: Path, folder: Path, compute_if_missing: Compute) -> None:
    if not note.exists():
        # Somebody else who waited for the same job has seen to it.
        return
    job = OmegaConf.load(note)
    assert isinstance(job, DictConfig)
    compute_if_missing(build.typed(job.config), folder, list(job.overrides), True)
    note.unlink(missing_ok=True)
    forget(note.parent, note.stem)
