"""JSON files with a schema, a version and a checksum: written the same to the byte every time, read with suspicion."""

import json
import re
from collections.abc import Mapping
from hashlib import sha256
from itertools import accumulate
from pathlib import Path
from typing import Any

LARGEST_DOCUMENT = 32 * 2**20
"""Bytes; a design of a thousand lenses found among ten thousand starts takes less."""

DEEPEST_NESTING = 16
"""Lists and records inside each other; the points of a keep-out in several parts are at 10."""

STRING = re.compile(r'"(?:[^"\\]++|\\.)*+"?', re.DOTALL)
NOT_A_BRACKET = re.compile(r"[^][{}]+")


def document(schema: str, version: int, content: Mapping[str, Any]) -> str:
    """Give the text of a document; the same content gives the same bytes.

    Every number is written so that it reads back bit for bit.

    Args:
        schema: what kind of document it is.
        version: of the schema.
        content: plain data: records, lists, texts, finite numbers, True, False and None.

    Raises:
        ValueError: a number is not finite, or the text would be larger than what is read.
    """
    head = {"schema": schema, "schema_version": version}
    sealed = head | {"checksum": _checksum(head | dict(content))} | dict(content)
    text = _laid_out(sealed) + "\n"
    if len(text) > LARGEST_DOCUMENT:
        raise ValueError(f"document must be at most {LARGEST_DOCUMENT} bytes, got {len(text)}")
    return text


def read_text(path: Path) -> str:
    """Read the text of a document.

    Raises:
        ValueError: it is too large or not text.
        OSError: it cannot be read.
    """
    with path.open("rb") as file:
        raw = file.read(LARGEST_DOCUMENT + 1)
    if len(raw) > LARGEST_DOCUMENT:
        raise ValueError(f"must be at most {LARGEST_DOCUMENT} bytes, got more")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError(f"must be text in UTF-8, got the byte {raw[error.start]:#04x} at {error.start}") from None


def document_content(text: str, schema: str, version: int) -> dict[str, Any]:
    """Give the content of a document, refused unless it is whole, unaltered and of this schema and version.

    Raises:
        ValueError: it is too deep, not JSON, of another kind or version, or its checksum differs.
    """
    content = _parsed(text)
    found = content.pop("schema", None)
    if found != schema:
        raise ValueError(f"schema must be {schema}, got {found!r:.40}")
    found = content.pop("schema_version", None)
    if found != version or isinstance(found, bool):
        raise ValueError(f"schema_version must be {version}, got {found!r:.40}")
    stored = content.pop("checksum", None)
    actual = _checksum({"schema": schema, "schema_version": version} | content)
    if stored != actual:
        raise ValueError(f"checksum must be {actual} for this content, got {stored!r:.80}: it was altered")
    return content


def _parsed(text: str) -> dict[str, Any]:
    _refuse_unless_shallow(text)
    try:
        content = json.loads(text, object_pairs_hook=_without_doubles, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise ValueError(f"must be whole JSON, got {error.msg} in line {error.lineno}") from None
    if not isinstance(content, dict):
        raise ValueError(f"must be a JSON record, got a {type(content).__name__}")
    return content


def _refuse_unless_shallow(text: str) -> None:
    """Count brackets before any parser goes down into them."""
    brackets = NOT_A_BRACKET.sub("", STRING.sub("", text))
    for depth in accumulate(1 if bracket in "[{" else -1 for bracket in brackets):
        if depth > DEEPEST_NESTING:
            raise ValueError(f"must be nested at most {DEEPEST_NESTING} deep, got more")


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) < len(pairs):
        keys = [key for key, _ in pairs]
        double = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"must have each key once, got {double!r:.40} twice")
    return content


def _refuse_constant(constant: str) -> None:
    raise ValueError(f"must hold finite numbers, got {constant}")


def _checksum(content: Mapping[str, Any]) -> str:
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return "sha256:" + sha256(canonical.encode("ascii")).hexdigest()


def _laid_out(value: Any, indent: str = "") -> str:
    """Give JSON to read: what holds only plain values is one line, everything else a line for each of its parts."""
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    if not any(isinstance(part, dict | list) for part in parts):
        return json.dumps(value, allow_nan=False)
    deeper = indent + "  "
    if isinstance(value, dict):
        lines = [f"{deeper}{json.dumps(key)}: {_laid_out(part, deeper)}" for key, part in value.items()]
        return "{\n" + ",\n".join(lines) + "\n" + indent + "}"
    lines = [deeper + _laid_out(part, deeper) for part in value]
    return "[\n" + ",\n".join(lines) + "\n" + indent + "]"
