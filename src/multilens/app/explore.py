"""`multilens explore`: several keys at once, continuous ones too, chosen trial by trial for the least of one or more numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from multilens.app.ending import DONE, NOTHING_FOUND, tell
from multilens.app.given import compose_given, read_given
from multilens.app.loading import load_torch
from multilens.app.plain import plain
from multilens.app.refusal import RefusedError, meant, refused_at
from multilens.app.space import Asked, read_space
from multilens.app.sweep import aligned
from multilens.app.sweep_folder import claim_of
from multilens.app.sweep_job import compute_if_missing
from multilens.sweep_row import COLUMN, Cell, SweepRow, cells
from multilens.sweeps.claim import claim_folder
from multilens.sweeps.job import read_job
from multilens.sweeps.locks import clear_half_written, write_held
from multilens.sweeps.space import each_end
from multilens.sweeps.table import write_tables
from multilens.table_text import csv_text

USAGE = """\
multilens explore out=FOLDER key=SPACE ... key=value ...    choose several keys at once

SPACE
  interval(20,45)                any number from 20 to 45
  int(interval(2,9))             any whole number from 2 to 9
  range(2,7)                     2, 3, 4, 5 or 6; range(1,2,0.25) has steps
  tag(log,interval(0.1,10))      any number, factors count rather than differences
  a,b,c  or  choice(a,b,c)       one of them; of the options of a group, too

Options
  minimise=rmse                  what is to be the least: figure, rmse, lens_count, aperture_area, body_area or back_area;
                                 of several, as in minimise=rmse,back_area, every best compromise is found (figure)
  trials=40                      how many designs are searched for (40)
  seed=0                         of what is chosen (0)
  out=FOLDER                     where the designs, the table and the best go

Examples
  multilens explore out=sweeps/island experiment=phone_back_island minimise=rmse,back_area \\
      'back.outline.width=interval(30,60)' 'lenses.count=range(2,6)'

The same command goes on where it was interrupted; more trials may be asked for. Several processes may work in one folder.
Optuna chooses; the extra `optuna` installs it. Exit code 3: nothing that was tried has a design."""

OBJECTIVES = ("figure", "rmse", "lens_count", "aperture_area", "body_area", "back_area")
"""What can be made least, by the names of `SweepRow`."""

BEST = "best.csv"
NUMBERS = {"trials": (40, 1), "seed": (0, 0)}
"""Each with what it is where nothing is said, and the least that it may be."""


@dataclass(frozen=True)
class _Options:
    """What is asked besides the configuration.

    Args:
        objectives: names of numbers of a row, to be made least.
        trials: how many.
        seed: of what is chosen.
        out: folder of the exploration.
    """

    objectives: tuple[str, ...]
    trials: int
    seed: int
    out: Path


def explore_command(words: Sequence[str]) -> int:
    """Explore, and write and print what is best.

    Args:
        words: options, key=SPACE and key=value, as USAGE tells.

    Returns:
        The exit code.

    Raises:
        RefusedError: the words cannot be understood, or the folder is another exploration's; one line.
        OSError: the folder cannot be read or written.
    """
    if find_spec("optuna") is None:
        raise RefusedError("explore must have Optuna, which is not installed: pip install 'multilens[optuna]'")
    own = [word for word in words if word.partition("=")[0] in ("minimise", "out", *NUMBERS)]
    options = _options(own)
    asked = read_space([word for word in words if word not in own])
    if not asked.space:
        raise RefusedError(
            "explore must have something to choose, as in 'back.outline.width=interval(20,45)', got none"
        )
    _open(options, asked)
    load_torch()
    from multilens.sweeps.study import explore, open_study

    with refused_at(f"out: {options.out}"):
        study = open_study(options.out, len(options.objectives))
    best = explore(
        study,
        options.out,
        asked.space,
        options.objectives,
        options.trials,
        options.seed,
        partial(_row, options.out, asked),
    )
    return _told(options, [row for row in write_tables(options.out) if row.job in best])


def _options(own: Sequence[str]) -> _Options:
    given = dict(word.split("=", 1) for word in own)
    for name in given:
        if len(same := [word for word in own if word.partition("=")[0] == name]) > 1:
            raise RefusedError(f"{name} must be given once, got {' '.join(same)}")
    if not given.get("out"):
        raise RefusedError("out must be a folder, as in out=sweeps/island, got none")
    objectives = tuple(given.get("minimise", "figure").split(","))
    for name in objectives:
        if name not in OBJECTIVES or objectives.count(name) > 1:
            known = ", ".join(OBJECTIVES)
            raise RefusedError(
                f"minimise must be one or more of {known}, each once, got {name or 'none'}{meant(name, OBJECTIVES)}"
            )
    numbers = {name: _number(name, given.get(name, str(usual)), least) for name, (usual, least) in NUMBERS.items()}
    return _Options(objectives, numbers["trials"], numbers["seed"], Path(given["out"]))


def _number(name: str, text: str, least: int) -> int:
    if not (text.isascii() and text.isdecimal() and int(text) >= least):
        raise RefusedError(f"{name} must be a whole number >= {least}, got {text or 'none'}")
    return int(text)


def _open(options: _Options, asked: Asked) -> None:
    """Check every end of what may be chosen, and take the folder, or find that it is this exploration's already."""
    configs = {
        changed: plain(read_given([*asked.presets, *asked.lines, *lines]).config)
        for changed, lines in each_end(asked.space)
    }
    chosen_by = {"minimise": ",".join(options.objectives), "seed": str(options.seed)}
    claim = claim_of(asked.fixed, {**asked.written, **chosen_by}, configs)
    with refused_at(f"out: {options.out}"):
        if options.out.exists() and not options.out.is_dir():
            raise ValueError("must be a folder, it is a file")
        claim_folder(options.out, claim, tell)
    clear_half_written(options.out)


def _row(out: Path, asked: Asked, number: int, settings: Sequence[tuple[str, str]]) -> SweepRow:
    """Give what comes of a trial, whose lock is held."""
    lines = [f"{key}={value}" for key, value in settings]
    # What does not go together is for the search to refuse: then the trial has a row that says so, and is done with.
    config = compose_given([*asked.presets, *asked.lines, *lines]).config
    compute_if_missing(config, out / str(number), [*asked.lines, *lines], True)
    return read_job(out / str(number)).row


def _told(options: _Options, best: Sequence[SweepRow]) -> int:
    """Write and print the best trials, and give the exit code."""
    if not best:
        tell(f"none of {options.trials} trials has a design; {options.out} says why")
        return NOTHING_FOUND
    write_held(options.out / BEST, csv_text(cells(best)))
    print(aligned(_short(options, best)))
    print(options.out / BEST)
    return DONE


def _short(options: _Options, best: Sequence[SweepRow]) -> list[list[Cell]]:
    """Give the table of the best with what was chosen and what is least, by the first of these."""
    ordered = sorted(best, key=lambda row: (getattr(row, options.objectives[0]), row.job))
    head = ["trial", *(key for key, _ in best[0].settings), *(COLUMN.get(name, name) for name in options.objectives)]
    return [head] + [
        [row.job, *(value for _, value in row.settings), *(getattr(row, name) for name in options.objectives)]
        for row in ordered
    ]
