"""Limits on the YAML files of a user, checked before anything expands them: 350 bytes of aliases can stand for gigabytes."""

from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path

import yaml

from multilens.app.refusal import RefusedError, one_line

MOST_BYTES = 262_144
MOST_NODES = 100_000
MOST_DEPTH = 32
MOST_FILES = 1000

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def refuse_wild_folders(arguments: Namespace) -> None:
    """Check the YAML files of every folder that the user adds to the search path.

    Args:
        arguments: as Hydra's parser gives them.

    Raises:
        RefusedError: see `refuse_wild_files`; or the path cannot be one of ours.
    """
    folders = [arguments.config_dir, arguments.config_path]
    for line in arguments.overrides:
        key, _, value = line.partition("=")
        if key.lstrip("+") == "hydra.searchpath":
            folders += [part.strip(" \"'") for part in value.strip("[] ").split(",") if part]
    if arguments.config_path and not Path(arguments.config_path).is_absolute():
        raise RefusedError(f"--config-path must be an absolute path, got {arguments.config_path}")
    for folder in folders:
        if folder and not folder.startswith("pkg://"):
            refuse_wild_files(Path(folder.removeprefix("file://")))


def refuse_wild_files(folder: Path) -> None:
    """Check every YAML file under a folder.

    Raises:
        RefusedError: a file is too large, too deep, too large once its aliases are written out, not YAML, or names further
            folders to search; or there are too many files.
    """
    if not folder.is_dir():
        raise RefusedError(f"{folder} must be a folder of configuration files, found none there")
    for count, path in enumerate(_files(folder)):
        if count >= MOST_FILES:
            raise RefusedError(f"{folder} must hold at most {MOST_FILES} YAML files, found more")
        refuse_wild_file(path)


def refuse_wild_file(path: Path) -> None:
    """Check one YAML file; see `refuse_wild_files`."""
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise RefusedError(f"{path} must be at most {MOST_BYTES} bytes, got {size}")
    try:
        text = path.read_text(encoding="utf-8")
        if "searchpath" in text:
            raise RefusedError(f"{path}: hydra.searchpath can be given on the command line only")
        _refuse_large_expansion(path, text)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise RefusedError(one_line(f"{path} must be YAML in UTF-8: {error}")) from None


def _refuse_large_expansion(path: Path, text: str) -> None:
    # The number of nodes below each open collection, and that of each finished anchor, aliases written out.
    open_nodes: list[int] = [0]
    open_anchors: list[str | None] = []
    anchors: dict[str, int] = {}
    for event in yaml.parse(text, Loader=_LOADER):
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in anchors:
                raise RefusedError(f"{path}: alias *{event.anchor} stands for nothing before it, or for what it is in")
            open_nodes[-1] += anchors[event.anchor]
        elif isinstance(event, yaml.ScalarEvent):
            open_nodes[-1] += 1
            if event.anchor:
                anchors[event.anchor] = 1
        elif isinstance(event, yaml.CollectionStartEvent):
            open_nodes.append(1)
            open_anchors.append(event.anchor)
        elif isinstance(event, yaml.CollectionEndEvent):
            nodes, anchor = open_nodes.pop(), open_anchors.pop()
            open_nodes[-1] += nodes
            if anchor:
                anchors[anchor] = nodes
        if len(open_nodes) > MOST_DEPTH:
            raise RefusedError(f"{path} must be at most {MOST_DEPTH} levels deep, got more")
        if open_nodes[-1] > MOST_NODES:
            raise RefusedError(f"{path} must hold at most {MOST_NODES} values with its aliases written out, got more")


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if path.suffix in (".yaml", ".yml") and path.is_file())
