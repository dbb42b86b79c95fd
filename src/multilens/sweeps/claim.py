"""Whose a folder is: sweep.json says of which sweep, and another one is refused.

The same sweep may come again, to go on after an interruption or to help another process with it.
"""

import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from multilens.documents import document, document_content, read_text
from multilens.fields import items, record, text
from multilens.storage import set_aside, write_whole
from multilens.sweeps.fingerprint import difference
from multilens.sweeps.locks import CLAIM, held

CLAIM_FILE = "sweep.json"
SCHEMA, SCHEMA_VERSION = "multilens.sweep", 1


@dataclass(frozen=True)
class Claim:
    """What makes a sweep this one.

    Args:
        fixed: keys that the command line sets to one value: they are no settings of a job.
        swept: keys and, as they are written, their values.
        config: with the first value of each, as plain data, without what changes no design.
        others: fingerprints of the configurations with another value of one key, by key=value.
        made_with: versions, as `storage.made_with` gives them.
    """

    fixed: tuple[str, ...]
    swept: Mapping[str, str]
    config: Mapping[str, Any]
    others: Mapping[str, str]
    made_with: Mapping[str, str]


def claim_folder(folder: Path, claim: Claim, listener: Callable[[str], None] = lambda line: None) -> None:
    """Take a folder for a sweep, or find that it is this sweep's already.

    Args:
        folder: of the sweep; made where it is not there.
        claim: what makes the sweep this one.
        listener: told in one line of a sweep.json that is damaged and set aside: the jobs themselves then say whose they are.

    Raises:
        ValueError: the folder is another sweep's, or holds something else.
        OSError: it cannot be read or written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / CLAIM_FILE
    _refuse_used(file)
    with held(folder, CLAIM):
        # Once more: before the lock somebody else may have come.
        _refuse_used(file)
        if file.exists():
            try:
                before = _read(file)
            except ValueError as damage:
                aside = set_aside(file)
                listener(f"{file}: {damage}; set aside as {aside.name}")
            else:
                _refuse_another(before, claim)
                return
        write_whole(file, document(SCHEMA, SCHEMA_VERSION, asdict(claim) | {"fixed": list(claim.fixed)}))


def read_claim(folder: Path) -> Claim:
    """Read what makes the sweep of a folder; a second time it is remembered, as long as the file is the same.

    Raises:
        ValueError: sweep.json is damaged.
        OSError: it is not there, or cannot be read.
    """
    file = folder / CLAIM_FILE
    return _remembered(file, os.stat(file).st_mtime_ns)


@lru_cache(maxsize=1)
def _remembered(file: Path, changed: int) -> Claim:
    return _read(file)


def _read(file: Path) -> Claim:
    content = document_content(read_text(file), SCHEMA, SCHEMA_VERSION)
    given = record(content, CLAIM_FILE, ("fixed", "swept", "config", "others", "made_with"))
    return Claim(
        tuple(text(key, "fixed") for key in items(given["fixed"], "fixed")),
        _texts(given["swept"], "swept"),
        record(given["config"], "config", (), optional=list(given["config"] or ())),
        _texts(given["others"], "others"),
        _texts(given["made_with"], "made_with"),
    )


def _refuse_used(file: Path) -> None:
    if not file.exists() and any(not path.name.startswith(".") for path in file.parent.iterdir()):
        raise ValueError("must be a new or empty folder, or that of the same sweep, it holds something already")


def _refuse_another(before: Claim, now: Claim) -> None:
    told = (
        difference(before.made_with, now.made_with)
        or difference(before.swept, now.swept)
        or difference(before.config, now.config)
    )
    changed = next((line for line in now.others if before.others.get(line) != now.others[line]), None)
    if not told and changed:
        told = f"{changed} stands for something else now"
    if told:
        raise ValueError(f"holds another sweep: {told}; name another folder, or remove this one")


def _texts(value: object, name: str) -> dict[str, str]:
    given = record(value, name, (), optional=list(value) if isinstance(value, dict) else ())
    return {key: text(each, f"{name}.{key}") for key, each in given.items()}
