"""A layout handed over: to DXF, SVG, GeoJSON or CSV."""

from collections.abc import Sequence
from pathlib import Path

from multilens.back import Back
from multilens.cad.formats import loaded, refuse_taken, written_form
from multilens.cad.plan import plan_of
from multilens.design import Design
from multilens.storage import write_whole


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
        ValueError: the end of the name is unknown, the file is there and `overwrite` is False, its folder is not there, the
            design is infeasible, or a back alone has no table.
        ModuleNotFoundError: DXF needs ezdxf, which is not installed.
        OSError: the file cannot be written.
    """
    export_all(what, [Path(path)], overwrite)


def export_all(what: Design | Back, paths: Sequence[Path], overwrite: bool) -> None:
    """Do as `export` does for several files; none is written unless the text of each could be made."""
    writers = [loaded("write", written_form(path)) for path in paths]
    for path in paths:
        refuse_taken(path, overwrite)
    plan = plan_of(what)
    texts = [write(plan) for write in writers]
    for path, text in zip(paths, texts, strict=True):
        write_whole(path, text)
