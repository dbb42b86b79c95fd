"""`multilens least`: the fewest lenses, the smallest back or the smallest aperture that reach a goal."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from multilens.app import build
from multilens.app.answer import answer, without_flag
from multilens.app.ending import DONE, NOTHING_FOUND, tell
from multilens.app.folder import refuse_used, write_folder
from multilens.app.given import Given, read_given
from multilens.app.loading import load_torch
from multilens.app.refusal import RefusedError, meant, refused_at
from multilens.app.tolerance import build_tolerance
from multilens.tolerance import Tolerance

if TYPE_CHECKING:
    from multilens.design import Design
    from multilens.inverse.answer import Answer, Trial
    from multilens.problem import Problem

USAGE = """\
multilens least WHAT GOAL key=value ...    the least that is enough

WHAT
  lenses      how few: the configured lenses in their order, the last again and again
  size        how small a back: its outline shrunk about its middle, what stands on it stays
  aperture    how small a radius that no lens exceeds

GOAL
  rmse=2                 root-mean-square error of at most 2 mm over the depths
  figure=2               the same for any metric, in the unit that it is printed with
  tolerance.mm=5         an error of at most 5 mm at every depth
  tolerance.percent=1    an error of at most 1 % of the depth at every depth

Options
  most=8                 lenses to count up to (8), or the largest size to look at (1, the back as it is)
  precision=0.01         part of a size or radius to which it is found
  out=FOLDER             save the design that is enough as a run folder
  --json                 print what was tried, the design and the paths of its files as JSON, and nothing else

Examples
  multilens least lenses rmse=3.5 experiment=phone_back_island
  multilens least size tolerance.percent=1 experiment=phone_back lenses.count=3
  multilens least aperture rmse=1.5 experiment=demo out=runs/narrow

The least is told with what is proved to be too little. Exit code 3: nothing that was tried is enough."""

NUMBERS = ("rmse", "figure", "most", "precision")

OPTIONS = {"lenses": {"most"}, "size": {"most", "precision"}, "aperture": {"precision"}}
"""What can be asked for the least of, and the numbers that each takes beside its goal."""


@dataclass(frozen=True)
class _Asked:
    """The words of the command line, sorted.

    Args:
        what: lenses, size or aperture.
        number: of each of NUMBERS that was given.
        out: folder for the design; None for none.
        as_json: whether to print JSON.
        given: the configuration.
    """

    what: str
    number: dict[str, float]
    out: Path | None
    as_json: bool
    given: Given


def least_command(words: Sequence[str]) -> int:
    """Find the least that is enough, print all that was tried, and save the design where that is asked for.

    Args:
        words: WHAT, a goal, options and key=value, as USAGE tells.

    Returns:
        The exit code.

    Raises:
        RefusedError: the words cannot be understood.
        OSError: the folder cannot be written.
    """
    asked = _sorted_words(words)
    goal = _goal(asked)
    load_torch()
    problem = _problem(asked)
    _refuse_strange_figure(asked, problem)
    found = _answer(asked, problem, goal)
    design = found.design
    said = "\n\n".join(filter(None, [str(found), "" if design is None else str(design)]))
    log = " ".join(["multilens least", *words]) + f"\n{said}\n"

    def write() -> list[Path]:
        return [] if design is None else write_folder(asked.out, design, asked.given.text, log)

    answer(said, design, write, asked.as_json, least=_plain(found))
    if design is None:
        tell(f"nothing that was tried is enough for {found.goal}")
        return NOTHING_FOUND
    return DONE


def _plain(found: "Answer") -> dict[str, Any]:
    """Give as plain data what was asked, what was tried, and what is certain."""
    trials = [
        {"value": trial.value, "verdict": trial.verdict, "figure": trial.figure, "bound": trial.bound}
        for trial in found.trials
    ]
    names = {"of": found.resource.name, "goal": found.goal, "figure": found.head}
    return names | {"enough": found.value, "proved_not_enough": found.proved_below, "trials": trials}


def _sorted_words(words: Sequence[str]) -> _Asked:
    as_json, words = without_flag(words)
    what, rest = next(iter(words), ""), words[1:]
    if what not in OPTIONS:
        raise RefusedError(
            f"least must be told of what: {', '.join(OPTIONS)}, as in multilens least lenses rmse=2 experiment=demo, "
            f"got {what or 'none'}{meant(what, OPTIONS)}"
        )
    named = [(word.partition("=")[0], word) for word in rest]
    own = {name: word.partition("=")[2] for name, word in named if name in (*NUMBERS, "out")}
    for name in own:
        if len(same := [word for other, word in named if other == name]) > 1:
            raise RefusedError(f"{name} must be given once, got {' '.join(same)}")
    lines = [word for name, word in named if name not in own]
    folder = own.pop("out", None)
    if folder == "":
        raise RefusedError("out must be one folder, as in out=runs/fewest, got none")
    out = None if folder is None else Path(folder)
    if out is not None:
        refuse_used(out)
    number = {name: _number(name, text) for name, text in own.items()}
    for name in number.keys() - OPTIONS[what] - {"rmse", "figure"}:
        raise RefusedError(f"{name} is no option of least {what}, got {name}={own[name]}")
    if what == "lenses" and not number.get("most", 1.0).is_integer():
        raise RefusedError(f"most must be a whole number of lenses, got {own['most']}")
    return _Asked(what, number, out, as_json, read_given(lines))


def _number(name: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not (isfinite(number) and number > 0):
        raise RefusedError(f"{name} must be a number > 0, got {text or 'nothing'}")
    if name == "most" and number > build.MOST_LENSES:
        raise RefusedError(f"most must be at most {build.MOST_LENSES}, got {text}")
    return number


def _goal(asked: _Asked) -> float | Tolerance:
    figures = [asked.number[name] for name in ("rmse", "figure") if name in asked.number]
    tolerance = build_tolerance(asked.given.config.tolerance)
    named = any(key.startswith("tolerance") for key in asked.given.keys)
    if len(figures) + named > 1:
        raise RefusedError("least must have one goal, rmse, figure or tolerance, got several")
    if figures:
        return figures[0]
    if tolerance is None:
        raise RefusedError("least must have a goal: rmse=2, figure=2, tolerance.mm=5 or tolerance.percent=1, got none")
    return tolerance


def _problem(asked: _Asked) -> "Problem":
    from multilens.problem import Problem

    question = build.build_question(asked.given.config)
    if not isinstance(question, Problem):
        raise RefusedError("robust must be none: least asks of a device as it is drawn")
    return question


def _refuse_strange_figure(asked: _Asked, problem: "Problem") -> None:
    metric = problem.metric
    if "rmse" in asked.number and metric.name != "RMSE":
        raise RefusedError(
            f"rmse is not what this metric tells: write figure={asked.number['rmse']:g} for {metric.name}"
        )


def _answer(asked: _Asked, problem: "Problem", goal: float | Tolerance) -> "Answer":
    from multilens.inverse import least

    finders: dict[str, Callable[..., Answer]] = {
        "lenses": least.fewest_lenses,
        "size": least.smallest_back,
        "aperture": least.smallest_aperture,
    }
    options: dict[str, float] = {name: asked.number[name] for name in OPTIONS[asked.what] if name in asked.number}
    if asked.what == "lenses" and "most" in options:
        options["most"] = int(options["most"])
    others = {"boxes": max(asked.given.config.search.proof, 1), "listener": _say}
    with refused_at(f"least {asked.what}"):
        return finders[asked.what](problem, goal, search=partial(_searched, asked), **others, **options)


def _searched(asked: _Asked, problem: "Problem") -> "Design":
    from multilens.app.search import search
    from multilens.app.terminal import progress_bar

    with progress_bar([], visible=True) as listener:
        # What cannot be reached is proved afterwards, where it is needed.
        return search(problem, asked.given.config, listener, proof=0)


def _say(trial: "Trial") -> None:
    """Tell whoever waits at a terminal of a trial at once; the table comes at the end."""
    if sys.stderr.isatty():
        figure = "" if trial.figure is None else f", {trial.figure:.4g}"
        print(f"  {trial.value:.4g}: {trial.verdict}{figure}", file=sys.stderr, flush=True)
