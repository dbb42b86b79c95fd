"""Small frozen dataclasses as plain data and back, whatever their fields: numbers, words, lists of them, other such nouns.

What is unknown, None, is left out of a record, and what may be unknown may be left out of one that is read. So a noun that learns
to know more still reads what it wrote before.
"""

from dataclasses import fields, is_dataclass
from types import UnionType
from typing import Any, get_args, get_origin, get_type_hints

from multilens.fields import choice, flag, items, number, record, text, whole_number, within

Record = dict[str, Any]


def noun_record(noun: Any) -> Record:
    """Give every field of a dataclass that is not None."""
    hints = get_type_hints(type(noun))
    values = {field.name: getattr(noun, field.name) for field in fields(noun)}
    return {name: _plain(hints[name], value) for name, value in values.items() if value is not None}


def read_noun(kind: Any, value: object, name: str) -> Any:
    """Read what `noun_record` gives, by the types that the fields of the dataclass say.

    Args:
        kind: the dataclass, which checks its own ranges.
        value: as it was read.
        name: path of the key from the top of the file.

    Raises:
        ValueError: a key is unknown or missing, or a value of the wrong type or out of its range.
    """
    known = {field.name: field for field in fields(kind)}
    needed = [key for key, field in known.items() if field.default is not None]
    given = record(value, name, needed, optional=[key for key in known if key not in needed])
    hints = get_type_hints(kind)
    read = {key: _read(hints[key], given[key], f"{name}.{key}") for key in known if key in given}
    with within(name):
        return kind(**read)


def named_record(noun: Any, table: dict[str, Any], what: str) -> str | Record:
    """Give the word that stands for a noun in a table, and with it what the noun holds, if it holds anything.

    Raises:
        TypeError: its class is not in the table: code is never written to a file.
    """
    words = {kind: word for word, kind in table.items()}
    if type(noun) not in words:
        raise TypeError(
            f"{what} must be among {', '.join(table)} to be saved, got a {type(noun).__name__}, which is code"
        )
    held = noun_record(noun)
    return {"name": words[type(noun)], **held} if held else words[type(noun)]


def read_named(table: dict[str, Any], value: object, name: str) -> Any:
    """Read what `named_record` gives; the word alone, or a record that has it as its name."""
    if not isinstance(value, dict):
        return read_noun(table[choice(value, name, tuple(table))], {}, name)
    word = choice(value.get("name"), f"{name}.name", tuple(table))
    return read_noun(table[word], {key: held for key, held in value.items() if key != "name"}, name)


def _plain(hint: Any, value: Any) -> Any:
    """Give a value as a file holds it; a whole number where a float is meant becomes one, as it will be when it is read."""
    if value is None:
        return None
    kinds = _known(hint)
    if len(kinds) > 1:
        return named_record(value, _by_name(kinds), "values")
    if is_dataclass(value):
        return noun_record(value)
    if isinstance(value, tuple):
        hints = get_args(kinds[0])
        return [_plain(hints[0] if hints[-1] is Ellipsis else hints[i], item) for i, item in enumerate(value)]
    return kinds[0](value)


def _read(hint: Any, value: object, name: str) -> Any:
    """Read a value of a type that a field of a noun may have."""
    kinds = _known(hint)
    if value is None and type(None) in get_args(hint):
        return None
    if len(kinds) > 1:
        return read_named(_by_name(kinds), value, name)
    kind = kinds[0]
    if get_origin(kind) is tuple:
        return _read_tuple(get_args(kind), value, name)
    return read_noun(kind, value, name) if is_dataclass(kind) else _PLAIN[kind](value, name)


def _known(hint: Any) -> list[Any]:
    """Give the types that a value may have once it is known: one, or several nouns."""
    return [one for one in get_args(hint) if one is not type(None)] if isinstance(hint, UnionType) else [hint]


def _by_name(kinds: list[Any]) -> dict[str, Any]:
    return {kind.__name__: kind for kind in kinds}


def _read_tuple(kinds: tuple[Any, ...], value: object, name: str) -> tuple[Any, ...]:
    if kinds[-1] is Ellipsis:
        found = items(value, name)
        kinds = kinds[:1] * len(found)
    else:
        found = items(value, name, len(kinds))
    return tuple(_read(kind, item, f"{name}[{i}]") for i, (kind, item) in enumerate(zip(kinds, found, strict=True)))


_PLAIN = {float: number, int: whole_number, str: text, bool: flag}
