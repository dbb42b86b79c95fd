"""Lenses and problems as plain data and back."""

from dataclasses import fields
from typing import Any

from multilens.cues import CUES
from multilens.disturbance import Disturbance
from multilens.field_of_view import Field
from multilens.fields import items, number, numbers, record, whole_number, within
from multilens.fusion import FUSIONS
from multilens.lens import Lens
from multilens.metrics import METRICS
from multilens.problem import Problem
from multilens.question import Question
from multilens.records.nouns import Record, named_record, noun_record, read_named, read_noun
from multilens.records.shapes import back_record, read_back
from multilens.robust import Robust

MOST_ERRORS = 10**7
"""Pairs and tiers times depths of a problem that is read: a small file must not ask for all the memory there is."""

MOST_DEVICES = 4096
"""Of a robust problem that is read, for the same reason."""

LATER = ("metric", "fusion", "guess", "field", "robust")
"""Keys of a problem that are left out where nothing but the default was asked."""


def lens_record(lens: Lens) -> Record:
    """Give everything that is known of a lens."""
    return noun_record(lens)


def read_lens(value: object, name: str) -> Lens:
    """Read what `lens_record` gives."""
    return read_noun(Lens, value, name)


def problem_record(problem: Question) -> Record:
    """Give a problem, of one device or of many; cues, metric and fusion by their names in tables.

    Raises:
        TypeError: its score is one's own, or one of its cues is not in the table: code is never written to a file.
    """
    if isinstance(problem, Robust):
        held = {field.name: getattr(problem, field.name) for field in fields(problem) if field.name != "problem"}
        held["disturbance"] = noun_record(problem.disturbance)
        return {**problem_record(problem.problem), "robust": held}
    if type(problem) is not Problem:
        raise TypeError(f"problem must be a Problem to be saved, got a {type(problem).__name__}, whose score is code")
    later = {
        "metric": named_record(problem.metric, METRICS, "metric"),
        "fusion": named_record(problem.fusion, FUSIONS, "fusion"),
        "guess": problem.guess,
        "field": None if problem.field is None else noun_record(problem.field),
    }
    return {
        "back": back_record(problem.back),
        "lenses": [lens_record(lens) for lens in problem.lenses],
        "depths": problem.depths.tolist(),
        "weights": problem.weights.tolist(),
        "cues": [named_record(cue, CUES, "cues") for cue in problem.cues],
        "gap": float(problem.gap),
        **{key: said for key, said in later.items() if said != _UNSAID[key]},
    }


def read_problem(value: object, name: str) -> Problem | Robust:
    """Read what `problem_record` gives."""
    given = record(value, name, ("back", "lenses", "depths", "weights", "cues", "gap"), optional=LATER)
    back = read_back(given["back"], f"{name}.back")
    lenses = [
        read_lens(item, f"{name}.lenses[{index}]")
        for index, item in enumerate(items(given["lenses"], f"{name}.lenses"))
    ]
    depths = numbers(given["depths"], f"{name}.depths")
    weights = numbers(given["weights"], f"{name}.weights")
    cues = [
        read_named(CUES, item, f"{name}.cues[{index}]")
        for index, item in enumerate(items(given["cues"], f"{name}.cues"))
    ]
    gap = number(given["gap"], f"{name}.gap")
    later = _read_later(given, name)
    count = (len(lenses) ** 2 + sum(lens.tiers for lens in lenses)) * len(depths)
    if count > MOST_ERRORS:
        raise ValueError(f"{name} must have at most {MOST_ERRORS:g} pairs and tiers times depths, got {count:.2g}")
    with within(name):
        problem = Problem(back, lenses, depths, weights, cues, gap, **later)
    return _read_robust(problem, given["robust"], f"{name}.robust") if "robust" in given else problem


_UNSAID = {"metric": "mean_square", "fusion": "best", "guess": None, "field": None}


def _read_later(fields: Record, name: str) -> dict[str, Any]:
    said = {key: fields.get(key, _UNSAID[key]) for key in _UNSAID}
    return {
        "metric": read_named(METRICS, said["metric"], f"{name}.metric"),
        "fusion": read_named(FUSIONS, said["fusion"], f"{name}.fusion"),
        "guess": None if said["guess"] is None else number(said["guess"], f"{name}.guess"),
        "field": None if said["field"] is None else read_noun(Field, said["field"], f"{name}.field"),
    }


def _read_robust(problem: Problem, value: object, name: str) -> Robust:
    given = record(value, name, ("disturbance", "level", "samples", "seed"))
    disturbance = read_noun(Disturbance, given["disturbance"], f"{name}.disturbance")
    level = number(given["level"], f"{name}.level")
    samples, seed = (whole_number(given[key], f"{name}.{key}") for key in ("samples", "seed"))
    if not 2 <= samples <= MOST_DEVICES:
        raise ValueError(f"{name}.samples must be from 2 to {MOST_DEVICES}, got {samples}")
    with within(name):
        return Robust(problem, disturbance, level, samples, seed)
