"""What `multilens --help` and `multilens` alone say, and `--help` behind a command.

The text is that of Hydra's own help, in conf/config.yaml. Hydra would compose a configuration and look through every group three
times before it prints that; here it is filled in at once.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from string import Template
from textwrap import fill

import yaml

from multilens.app.presets import config_folder, preset_groups

FLAGS = ("--help", "-h")
WIDTH = 120
CONFIG_DIR = ("--config-dir", "-cd")


def help_text(words: Sequence[str] = ()) -> str:
    """Give the help on everything: the commands, examples, and the presets that there are.

    Args:
        words: of the command line; the presets of `--config-dir FOLDER` are told, too.
    """
    told = yaml.safe_load((config_folder() / "config.yaml").read_text(encoding="utf-8"))["hydra"]["help"]
    groups = preset_groups([config_folder(), *_own_folders(words)])
    lines = [_line(group, options) for group, options in groups.items()]
    text = told["template"].replace("${hydra.help.header}", told["header"])
    text = text.replace("${hydra.help.footer}", told["footer"])
    return Template(text).substitute(APP_CONFIG_GROUPS="\n".join(lines)).strip()


def _line(group: str, options: list[str]) -> str:
    return fill(f"{group}: {', '.join(options)}", WIDTH, subsequent_indent="  ", break_on_hyphens=False)


def _own_folders(words: Sequence[str]) -> list[Path]:
    given = [word.partition("=")[2] for word in words if word.startswith(f"{CONFIG_DIR[0]}=")]
    return [Path(path) for path in [*given, *(after for flag, after in pairwise(words) if flag in CONFIG_DIR)]]
