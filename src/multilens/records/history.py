"""What a search went through, and what made a design, as plain data and back."""

from math import isfinite, nan

import torch

from multilens.convergence import Convergence
from multilens.fields import items, number, record, text, whole_number
from multilens.records.nouns import Record
from multilens.storage import Origin

SIGNIFICANT_DIGITS = 6
"""Of each score in the history of a search, which is there to be drawn."""


def convergence_record(convergence: Convergence) -> Record:
    """Give the history with 6 significant digits, a start in each row, and None for what is not finite."""
    return {
        "steps": list(convergence.steps),
        "polished": list(convergence.polished),
        "polished_scores": [score if isfinite(score) else None for score in convergence.polished_scores],
        "scores": [
            [float(f"{score:.{SIGNIFICANT_DIGITS}g}") if isfinite(score) else None for score in start]
            for start in convergence.scores.tolist()
        ],
    }


def read_convergence(value: object, name: str) -> Convergence:
    """Read what `convergence_record` gives, None as NaN."""
    fields = record(value, name, ("steps", "polished", "polished_scores", "scores"))
    steps, polished = (
        tuple(whole_number(item, f"{name}.{key}[{i}]") for i, item in enumerate(items(fields[key], f"{name}.{key}")))
        for key in ("steps", "polished")
    )
    starts = [
        _read_scores(start, f"{name}.scores[{index}]", len(steps))
        for index, start in enumerate(items(fields["scores"], f"{name}.scores"))
    ]
    for index in polished:
        if not 0 <= index < len(starts):
            raise ValueError(f"{name}.polished must name starts from 0 to {len(starts) - 1}, got {index}")
    polished_scores = tuple(_read_scores(fields["polished_scores"], f"{name}.polished_scores"))
    if len(polished_scores) > len(polished):
        raise ValueError(f"{name}.polished_scores must be at most {len(polished)}, got {len(polished_scores)}")
    scores = torch.tensor(starts, dtype=torch.float64).reshape(len(starts), len(steps))
    return Convergence(steps, scores, polished, polished_scores)


def origin_record(origin: Origin) -> Record:
    """Give what made a design; layouts that were known are told of where there were any."""
    fields = {
        "seed": int(origin.seed),
        "starts": int(origin.starts),
        "patience": int(origin.patience),
        "penalty": origin.penalty,
        "time_limit": None if origin.time_limit is None else float(origin.time_limit),
        "versions": dict(sorted(origin.versions.items())),
        "commit": origin.commit,
    }
    return fields | {"known": int(origin.known)} if origin.known else fields


def read_origin(value: object, name: str) -> Origin:
    """Read what `origin_record` gives."""
    keys = ("seed", "starts", "patience", "penalty", "time_limit", "versions", "commit")
    fields = record(value, name, keys, optional=["known"])
    seed, starts, patience = (whole_number(fields[key], f"{name}.{key}") for key in ("seed", "starts", "patience"))
    time_limit, versions, commit = fields["time_limit"], fields["versions"], fields["commit"]
    if not isinstance(versions, dict):
        raise ValueError(f"{name}.versions must be a record, got {versions!r:.40}")
    return Origin(
        seed,
        starts,
        patience,
        text(fields["penalty"], f"{name}.penalty"),
        None if time_limit is None else number(time_limit, f"{name}.time_limit"),
        {library: text(version, f"{name}.versions.{library:.40}") for library, version in versions.items()},
        None if commit is None else text(commit, f"{name}.commit"),
        whole_number(fields["known"], f"{name}.known") if "known" in fields else 0,
    )


def _read_scores(value: object, name: str, count: int | None = None) -> list[float]:
    return [
        nan if score is None else number(score, f"{name}[{index}]")
        for index, score in enumerate(items(value, name, count))
    ]
