"""Which format a file has, by the end of its name, and the module of it loaded."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

READ = {".dxf": "dxf", ".svg": "svg", ".geojson": "geojson", ".json": "geojson", ".wkt": "wkt"}
WRITTEN = {".dxf": "dxf", ".svg": "svg", ".geojson": "geojson", ".csv": "csv"}


def read_form(path: Path) -> str:
    """Give the format that a file is read as; a ValueError for any other end."""
    return _form(path, READ)


def written_form(path: Path) -> str:
    """Give the format that a file is written as; a ValueError for any other end."""
    return _form(path, WRITTEN)


def _form(path: Path, forms: dict[str, str]) -> str:
    form = forms.get(path.suffix.lower())
    if form is None:
        raise ValueError(f"{path} must end in one of {', '.join(forms)}, got {path.suffix or 'no such end'}")
    return form


def refuse_taken(path: Path, overwrite: bool) -> None:
    """Refuse a file that is there and may not be replaced, and one whose folder is not there.

    Raises:
        ValueError: it is so.
    """
    if path.exists() and not overwrite:
        raise ValueError(f"{path} must be a new file, it is there already: overwrite=true replaces it")
    if path.is_dir() or not path.parent.is_dir():
        raise ValueError(f"{path} must be a file in a folder that is there")


def loaded(verb: str, form: str) -> Callable[..., Any]:
    """Load what reads or writes a format, and nothing of the others.

    Args:
        verb: read or write.
        form: of `READ` or `WRITTEN`.

    Raises:
        ModuleNotFoundError: the library that does it is not installed; the message says how to.
    """
    try:
        return getattr(import_module(f"multilens.cad.{verb}_{form}"), f"{verb}_{form}")
    except ModuleNotFoundError as error:
        needs = f"{form.upper()} needs {error.name}, which is not installed: pip install 'multilens[cad]'"
        raise ModuleNotFoundError(needs, name=error.name) from None
