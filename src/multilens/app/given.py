"""A configuration from words of the command line, for the commands that Hydra does not run."""

from argparse import Namespace
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass

from omegaconf import OmegaConf, open_dict

from multilens.app import build
from multilens.app.check import composed, parsed
from multilens.app.compose import CONFIG_NAME, config_loader, open_hydra
from multilens.app.refusal import RefusedError
from multilens.app.schema import Config
from multilens.app.telling import told_in_one_line
from multilens.app.yaml_limits import refuse_wild_folders

CONFIG_DIR = "--config-dir"


@dataclass(frozen=True)
class Given:
    """What the words stand for.

    Args:
        config: composed.
        text: the same as YAML, every key written out.
        keys: what the words set, such as "depth" and "lenses.count".
    """

    config: Config
    text: str
    keys: tuple[str, ...]


def read_given(words: Sequence[str]) -> Given:
    """Compose a configuration and check it: what can be built without torch is built.

    Args:
        words: key=value, group=option, and `--config-dir FOLDER` for presets of one's own.

    Raises:
        RefusedError: something is unknown, out of its range, has several values or does not go together; one line.
    """
    given = compose_given(words)
    build.check(given.config)
    return given


def compose_given(words: Sequence[str]) -> Given:
    """Compose a configuration, whose values may be out of their ranges.

    Args:
        words: as of `read_given`.

    Raises:
        RefusedError: something is unknown or has several values; one line.
    """
    folder, lines = folder_of_presets(words)
    arguments = Namespace(config_path=None, config_dir=folder, overrides=lines)
    refuse_wild_folders(arguments)
    with open_hydra(arguments), told_in_one_line():
        overrides = parsed(lines, config_loader())
        for override in overrides:
            if override.is_sweep_override():
                raise RefusedError(f"{override.input_line}: must be one value, got several")
        whole = deepcopy(composed(CONFIG_NAME, lines))
        with open_dict(whole):
            whole.pop("hydra")
        config = build.typed(whole)
        text = OmegaConf.to_yaml(whole, resolve=True)
    return Given(config, text, tuple(override.key_or_group for override in overrides))


def folder_of_presets(words: Sequence[str]) -> tuple[str | None, list[str]]:
    """Take `--config-dir FOLDER` or `--config-dir=FOLDER` out of the words."""
    folder, lines, rest = None, [], iter(words)
    for word in rest:
        if word.partition("=")[0] != CONFIG_DIR:
            if word.startswith("-"):
                raise RefusedError(f"{word}: expected key=value or {CONFIG_DIR} FOLDER, got a flag")
            lines.append(word)
        elif (folder := word.partition("=")[2] or next(rest, None)) is None:
            raise RefusedError(f"{CONFIG_DIR} must be followed by a folder of presets, got none")
    return folder, lines
