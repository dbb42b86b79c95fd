"""The keys that a configuration has, and what is said of one that it does not have."""

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Any, get_args, get_origin, get_type_hints

from multilens.app.refusal import meant, one_line
from multilens.app.schema import Config


def no_such_option(group: str, name: str, options: Iterable[str]) -> str:
    """Say that a group has no such file, which ones it has and which was probably meant."""
    return one_line(f"{group}={name}: expected one of {', '.join(options)}, got {name}{meant(name, options)}")


def unknown_key(key: str, given: str) -> str:
    """Say that a key is unknown, which ones there are in its place and which was probably meant.

    Args:
        key: with dots.
        given: as it stands on the command line or in a file.
    """
    *above, _last = key.split(".")
    while above and not _below(above, Config):
        above.pop()
    siblings = _below(above, Config)
    where = ".".join(above) or "the configuration"
    whole = [".".join([*above, name]) for name in siblings]
    return one_line(
        f"{given}: unknown key {key}, {where} takes {', '.join(siblings)}{meant(key, [*whole, *_all_keys(Config)])}"
    )


def is_known(path: list[str], kind: Any = Config) -> bool:
    """Tell whether the schema, or a type within it, has a key."""
    return not path or any(
        is_known(path[1:], below) for name, below in _members(kind).items() if name in (path[0], "*")
    )


def _below(path: list[str], kind: Any) -> list[str]:
    members = _members(kind)
    if not path:
        return [name for name in members if name != "*"]
    return next((_below(path[1:], below) for name, below in members.items() if name in (path[0], "*")), [])


def _all_keys(kind: Any, above: str = "") -> Iterator[str]:
    for name, below in _members(kind).items():
        if name != "*":
            yield above + name
            yield from _all_keys(below, f"{above}{name}.")


@cache
def _members(kind: Any) -> dict[str, Any]:
    """Give what a type of the schema holds, by name; "*" stands for any name or index."""
    if is_dataclass(kind):
        hints = get_type_hints(kind)
        return {field.name: hints[field.name] for field in fields(kind)}
    if isinstance(kind, UnionType):
        return {name: below for one in get_args(kind) for name, below in _members(one).items()}
    if get_origin(kind) in (list, dict):
        return {"*": get_args(kind)[-1]}
    return {}
