"""`multilens report`: one HTML file that tells of what was saved."""

from collections.abc import Sequence
from pathlib import Path

from multilens.app.busy import busy
from multilens.app.ending import DONE
from multilens.app.refusal import RefusedError, one_line

USAGE = """\
multilens report RUN_FOLDER      one HTML file that tells of a saved run, with a slider of depths
multilens report SWEEP_FOLDER    one of a sweep: charts, layouts and table, linked job by job

The file needs no server and no network. Its path is printed.

Options
  out=FILE.html            where it goes (report.html in the folder); a file that is there is replaced

Examples
  multilens report runs/demo
  multilens report sweeps/by_depth
  multilens report runs/demo out=phone.html"""

OUT = "out="


def report_command(words: Sequence[str]) -> int:
    """Write the report of a run or of a sweep and print its path.

    Args:
        words: the folder, and `out=FILE.html` for another place than report.html in that folder.

    Returns:
        The exit code.

    Raises:
        RefusedError: there is no such folder, or what is in it is damaged.
        OSError: the report cannot be written.
    """
    folders = [word for word in words if not word.startswith(OUT)]
    outs = [word.removeprefix(OUT) for word in words if word.startswith(OUT)]
    if len(folders) != 1 or folders[0].startswith("-") or "=" in folders[0]:
        raise RefusedError(
            f"report must be given one folder, as in multilens report runs/demo, got {' '.join(folders) or 'none'}"
        )
    if len(outs) > 1 or not all(out.lower().endswith((".html", ".htm")) for out in outs):
        raise RefusedError(
            f"out must be one file that ends in .html, as in out=phone.html, got {' '.join(outs) or 'none'}"
        )
    folder = Path(folders[0])
    if not ((folder / "design.json").is_file() or any(folder.glob("*/row.json"))):
        missing = "there is no design.json in it and no job"
        raise RefusedError(
            f"report: {folder} must be the folder of a run that found a design, or of a sweep: {missing}"
        )
    from multilens.app.loading import load_torch

    load_torch()
    from multilens.report.write import write_report

    try:
        with busy("drawing the report") as say:
            path = write_report(folder, outs[0] if outs else None, say)
    except ValueError as error:
        raise RefusedError(f"report: {one_line(str(error))}") from None
    print(path)
    return DONE
