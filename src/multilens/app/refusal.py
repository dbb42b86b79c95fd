"""Refusals: bad input told in one line, with the name that was probably meant."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches


class RefusedError(Exception):
    """What was given cannot be run; the message is one line that names the key, what was expected and what was given."""


def one_line(text: str) -> str:
    """Give a text with all its white space, line breaks too, as single blanks, cut after 500 characters."""
    line = " ".join(text.split())
    return line if len(line) <= 500 else line[:500] + " ..."


def meant(given: str, known: Iterable[str]) -> str:
    """Give "; did you mean X?" for the known name nearest to the one given, or nothing where none is near."""
    near = get_close_matches(given, list(known), n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


@contextmanager
def refused_at(key: str) -> Iterator[None]:
    """Turn a ValueError raised inside into a refusal that names the key."""
    try:
        yield
    except ValueError as error:
        raise RefusedError(one_line(f"{key}: {error}")) from None
