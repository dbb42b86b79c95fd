"""A layout handed over: to DXF, SVG, GeoJSON or CSV."""

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

from multilens.back import Back
from multilens.cad.plan import Plan, plan_of
from multilens.design import Design
from multilens.storage import write_whole

FORMATS = {".dxf": "dxf", ".svg": "svg", ".geojson": "geojson", ".csv": "csv"}
"""What a file is written as, by the end of its name."""


def export(what: Design | Back, path: str | Path, overwrite: bool = False) -> None:
    """Write a layout, or a back alone, as a DXF, SVG, GeoJSON or CSV file, by the end of its name.

    DXF, SVG and GeoJSON hold the outline, the keep-outs, apertures, bodies and baselines, each on a layer of its name, and
    `read_back` makes the same back of them. Lengths are millimetres. CSV and SVG have the axes of the back, y downwards;
    DXF and GeoJSON have y upwards, so that the part looks the same. The same design gives the same bytes.

    Args:
        what: a design, or a back.
        path: of the file.
        overwrite: whether a file that is there is replaced.

    Raises:
        ValueError: the end of the name is unknown, the design is infeasible, or a back alone has no table.
        FileExistsError: the file is there, and `overwrite` is False.
        ModuleNotFoundError: DXF needs ezdxf, which is not installed.
        OSError: the file cannot be written.
    """
    export_all(what, [Path(path)], overwrite)


def export_all(what: Design | Back, paths: Sequence[Path], overwrite: bool) -> None:
    """Do as `export` does for several files; none is written unless the text of each could be made."""
    writers = [_writer(path) for path in paths]
    for path in paths:
        refuse_taken(path, overwrite)
    plan = plan_of(what)
    texts = [write(plan) for write in writers]
    for path, text in zip(paths, texts, strict=True):
        write_whole(path, text)


def refuse_taken(path: Path, overwrite: bool) -> None:
    """Refuse a file that is there and may not be replaced.

    Raises:
        FileExistsError: it is.
    """
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path} must be a new file, or overwrite must be true, it is there already")


def form_of(path: Path) -> str:
    """Give the format that a path asks for.

    Raises:
        ValueError: it asks for none of ours.
    """
    form = FORMATS.get(path.suffix.lower())
    if form is None:
        raise ValueError(f"{path} must end in one of {', '.join(FORMATS)}, got {path.suffix or 'no such end'}")
    return form


def _writer(path: Path) -> Callable[[Plan], str]:
    """Load what writes a format, and nothing of the others."""
    form = form_of(path)
    try:
        return getattr(import_module(f"multilens.cad.write_{form}"), f"write_{form}")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{form.upper()} needs {error.name}, which is not installed: pip install 'multilens[cad]'", name=error.name
        ) from None
