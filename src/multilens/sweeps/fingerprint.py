"""What a job is, in 64 digits: its resolved configuration and all that the answer depends on besides."""

import json
from collections.abc import Mapping
from hashlib import sha256
from typing import Any

NOT_ASKED = ("name", "sweep")
"""Keys of a configuration that change no design: where it goes, and how jobs go together."""


def asked(config: Mapping[str, Any]) -> dict[str, Any]:
    """Give the part of a configuration, as plain data, that a design depends on."""
    return {key: value for key, value in config.items() if key not in NOT_ASKED}


def fingerprint(config: Mapping[str, Any], made_with: Mapping[str, str]) -> str:
    """Give a checksum of what is asked and of what answers it.

    Args:
        config: resolved, as plain data.
        made_with: versions, as `storage.made_with` gives them.
    """
    return sha256(json.dumps([asked(config), made_with], sort_keys=True).encode()).hexdigest()


def difference(before: Any, now: Any, key: str = "") -> str:
    """Name the first key at which two pieces of plain data differ, with both values; nothing where they are the same."""
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        names = dict.fromkeys([*now, *before])
        below = (difference(before.get(name), now.get(name), f"{key}.{name}" if key else name) for name in names)
        return next(filter(None, below), "")
    return "" if before == now else f"{key} was {_shown(before)} there and is {_shown(now)} now"


def _shown(value: Any) -> str:
    text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= 80 else text[:80] + "..."
