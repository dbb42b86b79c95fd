"""An exploration: Optuna chooses what to try next, by what came of the trials before.

study.journal in the folder is Optuna's own record of it, and may be opened with Optuna's tools. Any number of processes may work
in one folder. A trial depends on the seed, its number and the trials before it: so a single process that is interrupted and
started again chooses the same trials.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from random import Random
from time import sleep
from typing import Any

import optuna
from optuna.samplers import TPESampler
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.study import Study, StudyDirection
from optuna.trial import Trial, TrialState

from multilens.sweep_row import FAILED, SweepRow
from multilens.sweeps.locks import BETWEEN_LOOKS, free_lock, held, held_if_free
from multilens.sweeps.space import Space, Span

JOURNAL, STUDY = "study.journal", "study"

Settings = tuple[tuple[str, str], ...]
Compute = Callable[[int, Settings], SweepRow]


def open_study(folder: Path, objectives: int) -> Study:
    """Open the record of an exploration, or begin one.

    Args:
        folder: of the exploration; there.
        objectives: how many numbers are to be made least, > 0.

    Raises:
        ValueError: the record is damaged.
        OSError: it cannot be read or written.
    """
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna.create_study(
        storage=JournalStorage(_journal(folder)),
        study_name=STUDY,
        directions=[StudyDirection.MINIMIZE] * objectives,
        load_if_exists=True,
    )


def explore(
    study: Study, folder: Path, space: Space, objectives: Sequence[str], trials: int, seed: int, compute: Compute
) -> tuple[int, ...]:
    """Try until there are enough trials, and give those that no other beats in every objective at once.

    A trial without a design has no number to tell: Optuna is told that it came to nothing, and learns to stay away. One that
    failed by a fault of ours says nothing, and nothing is learned from it.

    Args:
        study: as `open_study` gives it.
        folder: of the exploration.
        space: what may be chosen.
        objectives: names of numbers of a `SweepRow`.
        trials: how many there are to be, with those that are there already.
        seed: of what is chosen, >= 0.
        compute: gives the row of a trial by its number and settings, at once where it was computed before.

    Returns:
        The numbers of the best, ascending: of one objective those with the least, of several the Pareto front.
    """
    while True:
        with _next(study, folder, space, trials, seed) as trial:
            if trial is not None:
                _tell(study, trial, compute(trial.number, _settings(trial, space)), objectives)
            elif study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
                # Others compute the last ones. If they end without an answer, it is for us to do.
                sleep(BETWEEN_LOOKS)
            else:
                return tuple(sorted(best.number for best in study.best_trials)) if _any_complete(study) else ()


@contextmanager
def _next(study: Study, folder: Path, space: Space, trials: int, seed: int) -> Iterator[Trial | None]:
    """Give a trial whose lock is held, one that was left behind or a new one; None where all are done or with others."""
    with ExitStack() as locks:
        with held(folder, STUDY):
            trial = _left_behind(study, folder, locks)
            if trial is None and len(study.get_trials(deepcopy=False)) < trials:
                trial = study.ask()
                locks.enter_context(held(folder, str(trial.number)))
            if trial is not None:
                # Begun anew for each trial: what is chosen must not depend on what this process chose before.
                study.sampler = TPESampler(seed=Random(f"{seed} {trial.number}").getrandbits(32))
                _settings(trial, space)
        yield trial


def _left_behind(study: Study, folder: Path, locks: ExitStack) -> Trial | None:
    """Give a trial that was begun by a process that is gone, with what it had chosen."""
    for begun in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
        if locks.enter_context(held_if_free(folder, str(begun.number))):
            return Trial(study, begun._trial_id)
    return None


def _settings(trial: Trial, space: Space) -> Settings:
    """Choose a value for every key, or give what was chosen before."""
    return tuple((each.key, _chosen(trial, each)) for each in space)


def _chosen(trial: Trial, each: Any) -> str:
    if not isinstance(each, Span):
        return trial.suggest_categorical(each.key, each.values)
    if each.whole:
        step = 1 if each.step is None else int(each.step)
        return each.text(trial.suggest_int(each.key, int(each.low), int(each.high), step=step, log=each.log))
    return each.text(trial.suggest_float(each.key, each.low, each.high, step=each.step, log=each.log))


def _tell(study: Study, trial: Trial, row: SweepRow, objectives: Sequence[str]) -> None:
    values = [getattr(row, name) for name in objectives]
    if None not in values:
        study.tell(trial, values, skip_if_finished=True)
    else:
        state = TrialState.FAIL if row.status == FAILED else TrialState.PRUNED
        study.tell(trial, state=state, skip_if_finished=True)


def _any_complete(study: Study) -> bool:
    return bool(study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,)))


def _journal(folder: Path) -> JournalFileBackend:
    """Open the file of the record, without a line that a power cut has left half written."""
    file = folder / JOURNAL
    lock = free_lock(folder, JOURNAL)
    with lock:
        written = file.read_bytes() if file.exists() else b""
        whole = written.rfind(b"\n") + 1
        if whole < len(written):
            os.truncate(file, whole)
    # Optuna's own lock outlives a process that is killed, for half a minute; this one does not.
    return JournalFileBackend(str(file), lock)  # pyright: ignore[reportArgumentType] -- only acquire and release are called
