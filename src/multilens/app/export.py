"""`multilens export`: the layout of a saved design for CAD, graphics, GIS and spreadsheets."""

from collections.abc import Sequence
from pathlib import Path

from multilens.app.ending import DONE
from multilens.app.refusal import RefusedError, one_line, refused_at

USAGE = """\
multilens export RUN_FOLDER FILE ...    the layout of a saved design as files, by the ends of their names

FILE
  layout.dxf       outline, keep-outs, bodies, apertures, baselines and labels, each on its layer; mm, y upwards
  layout.svg       the same to scale, in groups; mm
  layout.geojson   the same as features; mm, y upwards
  layout.csv       a row for each lens

RUN_FOLDER may be a design.json, too.

Options
  overwrite=true   replace files that are there

Examples
  multilens export runs/demo layout.dxf
  multilens export runs/demo/design.json layout.svg layout.csv overwrite=true

DXF needs ezdxf: pip install 'multilens[cad]'."""

OVERWRITE = {"overwrite=true": True, "overwrite=false": False}


def export_command(words: Sequence[str]) -> int:
    """Write the files that the words name, and print their paths.

    Args:
        words: a run folder or a design.json, the files, and `overwrite=true`.

    Returns:
        The exit code.

    Raises:
        RefusedError: the words cannot be understood, a file is there already, or the design is damaged.
        OSError: a file cannot be written.
    """
    source, paths, overwrite = _sorted_words(words)
    from multilens.app.loading import load_torch

    load_torch()
    from multilens.cad.export import export_all
    from multilens.design import Design

    with refused_at("export"):
        design = Design.load(source)
        try:
            export_all(design, paths, overwrite)
        except ModuleNotFoundError as error:
            raise RefusedError(f"export: {error}") from None
    for path in paths:
        print(path)
    return DONE


def _sorted_words(words: Sequence[str]) -> tuple[Path, list[Path], bool]:
    """Give the design's file, the files to write, and whether they may be replaced."""
    from multilens.cad.formats import refuse_taken, written_form

    options = [word for word in words if "=" in word]
    for word in options:
        if word not in OVERWRITE:
            raise RefusedError(one_line(f"export takes overwrite=true, got {word}"))
    flags = [word for word in words if word.startswith("-")]
    if flags:
        raise RefusedError(one_line(f"export takes a run folder, files and overwrite=true, got {flags[0]}"))
    names = [word for word in words if word not in options]
    if len(names) < 2:
        got = " ".join(names) or "none"
        raise RefusedError(
            f"export must be given a run folder and files, as in multilens export runs/demo layout.dxf, got {got}"
        )
    given, paths, overwrite = (
        Path(names[0]),
        [Path(name) for name in names[1:]],
        any(OVERWRITE[word] for word in options),
    )
    source = given / "design.json" if given.is_dir() else given
    if not source.is_file():
        raise RefusedError(f"export: {given} must be a design.json or the folder of a run that found one, it is not")
    with refused_at("export"):
        for path in paths:
            written_form(path)
            refuse_taken(path, overwrite)
    return source, paths, overwrite
