"""What a command that has a design prints, in words or as JSON, before and after its folder is written."""

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from multilens.design import Design

FLAG = "--json"


def without_flag(words: Sequence[str]) -> tuple[bool, list[str]]:
    """Give whether JSON is asked for, and the other words."""
    rest = [word for word in words if word != FLAG]
    return len(rest) < len(words), rest


def answer(
    said: str, design: "Design | None", write: Callable[[], Sequence[Path]], as_json: bool, **others: Any
) -> None:
    """Print an answer and write its files: of JSON one object, and nothing else, on stdout.

    Args:
        said: the answer in words. Who sits at a terminal reads it while the files are written.
        design: None where nothing was enough.
        write: writes the files and gives their paths.
        as_json: whether to print `others`, the paths and the design as `design.json` holds it, instead of words.
        others: plain data.

    Raises:
        OSError: the files cannot be written; the answer is printed all the same.
    """
    # Behind a pipe whoever reads may stop at any line, and the files are to be written all the same.
    at_once = sys.stdout.isatty() and not as_json
    if at_once:
        print(said)
    left = "" if at_once else said
    try:
        files = [str(path) for path in write()]
    except OSError:
        # A full disk must not take the answer of a long search with it.
        _print(left, design, [], as_json, others)
        raise
    _print(left, design, files, as_json, others)


def _print(said: str, design: "Design | None", files: Sequence[str], as_json: bool, others: dict[str, Any]) -> None:
    if as_json:
        content = None if design is None else json.loads(design.to_json())
        print(json.dumps({**others, "files": files, "design": content}, indent=2, allow_nan=False))
        return
    for line in [*filter(None, [said]), *([""] if files else []), *files]:
        print(line)
