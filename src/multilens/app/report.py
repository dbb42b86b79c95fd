"""`multilens report`: one HTML file that tells of what was saved."""

from collections.abc import Sequence
from pathlib import Path
from time import monotonic

from rich.console import Console

from multilens.app.ending import DONE
from multilens.app.refusal import RefusedError, one_line

USAGE = """\
multilens report RUN_FOLDER    one HTML file that tells of a saved run, with a slider of depths

The file needs no server and no network. Its path is printed.

Options
  out=FILE.html            where it goes (report.html in the folder)

Examples
  multilens report runs/demo
  multilens report runs/demo out=phone.html"""

OUT = "out="

AT_ONCE = 2.0
"""s; what takes no longer needs no telling."""


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
    if len(outs) > 1 or "" in outs:
        raise RefusedError(f"out must be one file, as in out=phone.html, got {' '.join(outs) or 'none'}")
    folder = Path(folders[0])
    if not ((folder / "design.json").is_file() or any(folder.glob("*/row.json"))):
        missing = "there is no design.json in it and no job"
        raise RefusedError(
            f"report: {folder} must be the folder of a run that found a design, or of a sweep: {missing}"
        )
    from multilens.app.loading import load_torch

    load_torch()
    from multilens.report.write import write_report

    began, status = monotonic(), Console(stderr=True).status("")

    def listen(read: int, every: int) -> None:
        if monotonic() - began > AT_ONCE:
            status.update(f"designs read: {read} of {every}")
            status.start()

    try:
        path = write_report(folder, outs[0] if outs else None, listen)
    except ValueError as error:
        raise RefusedError(f"report: {one_line(str(error))}") from None
    finally:
        status.stop()
    print(path)
    return DONE
