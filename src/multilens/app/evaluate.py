"""`multilens evaluate`: score a layout that is given, by a design, a run folder or a configuration."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from multilens.app import build
from multilens.app.answer import answer, without_flag
from multilens.app.busy import busy
from multilens.app.ending import DONE
from multilens.app.estimates import notes
from multilens.app.folder import refuse_used, write_folder
from multilens.app.given import Given, read_given
from multilens.app.loading import load_torch
from multilens.app.refusal import RefusedError, one_line
from multilens.app.tolerance import build_tolerance

if TYPE_CHECKING:
    from multilens.design import Design
    from multilens.problem import Problem

USAGE = """\
multilens evaluate experiment=NAME key=value ...        score a device whose lenses have their places
multilens evaluate RUN_FOLDER|DESIGN.json key=value ... score a saved design, as it is or under another question

Options
  out=FOLDER               save what was scored as a run folder
  --json                   print the design and the paths of its files as JSON, and nothing else
  --config-dir FOLDER      take presets of your own as well

Of a saved design the words may set depth, field_of_view, cues, metric, fusion, robust and tolerance, and scene beside cues. The
rest is hardware, which it has.

Examples
  multilens evaluate experiment=devices/iphone_15_pro_max
  multilens evaluate experiment=demo lenses.count=2 'lenses.places=[[14,14],[60,14]]' out=runs/mine
  multilens evaluate runs/mine depth=portrait
  multilens evaluate runs/mine cues=photometric scene=dim tolerance.mm=5 --json"""

QUESTION = {
    "depth": ("depths", "weights"),
    "field_of_view": ("field",),
    "cues": ("cues",),
    "scene": ("cues",),
    "metric": ("metric",),
    "fusion": ("fusion", "guess"),
    "robust": (),
    "tolerance": (),
}
"""Parts of a configuration under which a stored layout can be scored anew, and what they are of a problem (of which
devices may differ: then of none); the rest is the hardware, which it has."""

OUT = "out"


@dataclass(frozen=True)
class _Asked:
    """The words of the command line, sorted: what to score, where to write, whether as JSON, and key=value."""

    path: Path | None
    out: Path | None
    as_json: bool
    lines: tuple[str, ...]


def evaluate_command(words: Sequence[str]) -> int:
    """Score what the words name, print it, and write a run folder where one is asked for.

    Args:
        words: `DESIGN.json` or `RUN_FOLDER` or neither, key=value, `out=FOLDER` and `--json`.

    Returns:
        The exit code.

    Raises:
        RefusedError: the words cannot be understood, or a place that is needed is unknown.
        OSError: a file cannot be read or written.
    """
    asked = _sorted_words(words)
    if asked.out is not None:
        refuse_used(asked.out)
    given = None if asked.path is not None and not asked.lines else read_given(asked.lines)
    load_torch()
    from multilens.app.account import account

    with busy("scoring"):
        if asked.path is None:
            assert given is not None
            told = notes(given.config, given.keys)
            design, text = _within(_of_configuration(given), given), given.text
            lines = [account(design, chosen=True), told]
        else:
            design = _within(_of_file(asked.path, given), given)
            text = f"design: {asked.path}\noverrides: {list(asked.lines)}\n"
            lines = [account(design, chosen=False)]
    said = "\n\n".join(filter(None, lines))
    log = " ".join(["multilens evaluate", *words]) + f"\n{said}\n"
    answer(said, design, lambda: write_folder(asked.out, design, text, log), asked.as_json)
    return DONE


def _within(design: "Design", given: Given | None) -> "Design":
    """Give a design whose working range is told where a tolerance is named."""
    tolerance = None if given is None else build_tolerance(given.config.tolerance)
    return design if tolerance is None else replace(design, tolerance=tolerance)


def _sorted_words(words: Sequence[str]) -> _Asked:
    as_json, words = without_flag(words)
    paths = [word for word in words[:1] if "=" not in word and not word.startswith("-")]
    rest = list(words[len(paths) :])
    outs = [word.partition("=")[2] for word in rest if word.partition("=")[0] == OUT]
    if len(outs) > 1 or "" in outs:
        raise RefusedError(f"out must be one folder, as in out=runs/phone, got {' '.join(outs) or 'none'}")
    lines = tuple(word for word in rest if word.partition("=")[0] != OUT)
    if not paths and not lines:
        raise RefusedError(
            "evaluate must be given a design.json, a run folder or a configuration, as in multilens evaluate "
            "experiment=devices/iphone_15_pro_max, got none"
        )
    return _Asked(_design_file(Path(paths[0])) if paths else None, Path(outs[0]) if outs else None, as_json, lines)


def _design_file(path: Path) -> Path:
    file = path / "design.json" if path.is_dir() else path
    if not file.is_file():
        raise RefusedError(f"evaluate: {path} must be a design.json or the folder of a run that found one, it is not")
    return file


def _of_configuration(given: Given) -> "Design":
    from multilens.search.evaluate import evaluate, unplaced

    problem = build.build_problem(given.config)
    for index in unplaced(problem):
        each = given.config.lenses.each
        name = each[index].name if each is not None else None
        key = f"lenses.each.{index}" if each is not None else "lenses.lens"
        raise RefusedError(
            f"lens {index + 1}{'' if name is None else f' ({name})'} has no known place: set {key}.position=[x,y], "
            f"or the places of all as lenses.places=[[x,y],...], in mm"
        )
    try:
        return replace(evaluate(problem), problem=build.build_question(given.config))
    except ValueError as error:
        raise RefusedError(one_line(str(error))) from None


def _of_file(path: Path, given: Given | None) -> "Design":
    from multilens.design import Design
    from multilens.problem import Problem
    from multilens.robust import Robust
    from multilens.search.evaluate import as_given

    try:
        design = Design.load(path)
    except ValueError as error:
        raise RefusedError(f"evaluate: {one_line(str(error))}") from None
    problem = design.problem.problem if isinstance(design.problem, Robust) else design.problem
    if given is None or not isinstance(problem, Problem):
        return design
    anew = _asked_anew(problem, given)
    if any(_part(key) == "robust" for key in given.keys):
        question = build.build_robust(given.config.robust, anew)
    else:
        question = replace(design.problem, problem=anew) if isinstance(design.problem, Robust) else anew
    return replace(as_given(question, design.layout), tolerance=design.tolerance)


def _asked_anew(problem: "Problem", given: Given) -> "Problem":
    """Give the problem of a stored layout with those parts of the question that the words name."""
    parts = {_part(key) for key in given.keys}
    for part in sorted(parts - set(QUESTION)):
        raise RefusedError(f"{part}: a stored layout can be scored under another {', '.join(QUESTION)}, got {part}")
    if "scene" in parts and "cues" not in parts:
        raise RefusedError(
            "scene: a stored layout keeps its cues and what they look at, unless cues come with it: add cues=photometric, "
            "or whichever it is to be scored by"
        )
    anew = build.build_problem(given.config)
    others = {name: getattr(anew, name) for part in parts for name in QUESTION[part]}
    # A lens that could focus where the depths were still could: its bounds are hardware.
    pairs = zip(problem.lenses, problem.focus_range, strict=True)
    return replace(problem, lenses=[replace(lens, focus=focus) for lens, focus in pairs], **others)


def _part(key: str) -> str:
    return key.lstrip("+~").split(".")[0]
