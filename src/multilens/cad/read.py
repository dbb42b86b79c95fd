"""A back from a drawing, whichever format it is in."""

from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from multilens.back import Back
from multilens.cad.drawing import BackRead, Wanted, back_of
from multilens.cad.formats import loaded, read_form
from multilens.cad.layers import OUTLINE
from multilens.ranges import refuse_unless_not_negative

LARGEST_FILE = 16 * 2**20
"""Bytes."""

CUT = ("dxf", "svg")
"""Formats with curves that may have to be cut into edges."""

COARSEST = 10.0
"""mm."""


def read_back(
    path: str | Path,
    units: str | None = None,
    outline: str = OUTLINE,
    keep_outs: Sequence[str] | None = None,
    clearance: float = 0.0,
    tolerance: float = 0.01,
) -> Back:
    """Read a back from a DXF, SVG, GeoJSON or WKT file, by the end of its name.

    x runs to the right and y down on a back. A file in which y runs up, as all of these but SVG, is turned over accordingly:
    what is seen stays as it is. Circles, and convex curves with one radius at every corner, are exact, and so is what is
    straight; other curves are cut into edges on the safe side.

    Args:
        path: of the file.
        units: of its numbers, "mm", "cm", "m", "um", "inch" or "ft"; None for those that the file says.
        outline: name of the layer, group or element that is the outline.
        keep_outs: names of those that are keep-outs, () for none; None takes the layer "keep-outs" if there is one.
        clearance: that bodies keep from each keep-out of which the file says none, mm, >= 0.
        tolerance: by which a rim may move to the safe side where it cannot be exact, mm, > 0.

    Raises:
        ValueError: the units are unknown, a layer is missing, a curve is open or crosses itself, or the file is damaged or too
            large; the file is named.
        ModuleNotFoundError: the library that reads the format is not installed.
        OSError: the file cannot be read.
    """
    wanted = Wanted(outline, None if keep_outs is None else tuple(keep_outs), clearance, tolerance)
    return read_with_notes(Path(path), units, wanted).back


def read_with_notes(path: Path, units: str | None, wanted: Wanted) -> BackRead:
    """Do as `read_back` does, and tell what is worth knowing of it."""
    if not (isfinite(wanted.tolerance) and 0 < wanted.tolerance <= COARSEST):
        raise ValueError(f"tolerance must be > 0 and at most {COARSEST:g} mm, got {wanted.tolerance:g}")
    refuse_unless_not_negative("clearance", wanted.clearance)
    form = read_form(path)
    read = loaded("read", form)
    try:
        text = _text(path)
        drawing = read(text, units, wanted.tolerance) if form in CUT else read(text, units)
        return back_of(drawing, wanted)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _text(path: Path) -> str:
    with path.open("rb") as file:
        raw = file.read(LARGEST_FILE + 1)
    if len(raw) > LARGEST_FILE:
        raise ValueError(f"file must be at most {LARGEST_FILE} bytes, got more")
    # Old DXF files are in the code page of some country, which changes names alone.
    return raw.decode("utf-8", errors="surrogateescape" if path.suffix.lower() == ".dxf" else "strict").lstrip("\ufeff")
