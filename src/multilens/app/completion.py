"""What the Tab key offers: the commands and their flags, and in their words whatever Hydra knows of groups and keys.

What `multilens -sc install=SHELL` installs asks `multilens -sc query=SHELL` with the line so far in COMP_LINE, and takes
every word that is printed.
"""

import os
from collections.abc import Sequence
from contextlib import redirect_stdout
from glob import escape, glob
from io import StringIO

from multilens.app.design import design_command, environment
from multilens.app.presets import config_folder, preset_groups
from multilens.app.refusal import RefusedError

LINE = "COMP_LINE"

FIRST = {"least": ("lenses", "size", "aperture")}
"""What must be the first word behind a command."""

OF_RUNS = ("animate", "evaluate", "export", "plot", "report")
"""Commands whose first word is a run folder, or may be."""

WITHOUT_KEYS = ("animate", "export", "plot", "report")
"""Commands that take no key=value."""

FLAGS = ("--help", "--version", "--json", "--multirun", "--cfg", "--config-dir", "--hydra-help")


def complete(words: Sequence[str], commands: Sequence[str]) -> None:
    """Print everything that may stand in place of the last word of the line in COMP_LINE, a word a line.

    Args:
        words: with which the shell asks.
        commands: that the first word may be.
    """
    line = os.environ.get(LINE, "")
    *before, word = [*line.split()[1:], *([""] if line.endswith(" ") else [])] or [""]
    command = before[0] if before and before[0] in commands else None
    if word.startswith("-"):
        offered = list(FLAGS)
    elif command in FIRST and len(before) == 1:
        offered = list(FIRST[command])
    else:
        offered = [] if before else list(commands)
        offered += _paths(word) if command in OF_RUNS and len(before) == 1 else []
        given = [other for other in before if "=" in other]
        offered += [] if command in WITHOUT_KEYS else _of_hydra(words, given, word)
    print("\n".join(sorted(one for one in set(offered) if one.startswith(word))))


def _paths(word: str) -> list[str]:
    return [f"{path}/" if os.path.isdir(path) else path for path in glob(f"{escape(word)}*")]


def _of_hydra(words: Sequence[str], given: Sequence[str], word: str) -> list[str]:
    """Ask Hydra about a word behind others, and add what it leaves out: presets in folders below their group."""
    groups = preset_groups([config_folder()])
    below = [group.partition("/") for group in groups if "/" in group]
    presets = [
        f"{top}={inner}/{option}" for top, _, inner in below for option in groups[f"{top}/{inner}"] if "=" in word
    ]
    line = " ".join(["multilens", *given, word])
    try:
        with redirect_stdout(StringIO()) as said, environment(LINE, line):
            design_command(words)
    except RefusedError:
        # Something before is not right yet; a line that is being typed is not refused.
        return presets
    return presets + [f"{one}=" if one in groups else one for one in said.getvalue().split()]
