"""A report of whatever is given: a design, the folder of a run."""

from pathlib import Path

from multilens.design import Design
from multilens.documents import read_text
from multilens.report.run_page import run_page
from multilens.runs import CONFIG, DESIGN, LOG
from multilens.storage import ESTIMATES, write_whole

REPORT = "report.html"


def write_report(what: Design | str | Path, path: str | Path | None = None) -> Path:
    """Write one HTML file that tells of a design: it needs no other file, no server and no network.

    The same design, or folder, gives the same bytes.

    Args:
        what: a design, or the folder of a run.
        path: of the file, which is replaced if it is there; None puts report.html into the folder.

    Returns:
        The path of the file.

    Raises:
        ValueError: the design is infeasible, a file of the folder is damaged, or there is no folder to put the report into.
        OSError: the folder holds no design, or something cannot be read or written.
    """
    if isinstance(what, Design):
        if path is None:
            raise ValueError("path must be given for the report of a design, got None")
        text = run_page(what)
    else:
        text = _page_of_run(Path(what))
        path = Path(what) / REPORT if path is None else path
    write_whole(Path(path), text)
    return Path(path)


def _page_of_run(folder: Path) -> str:
    design = Design.load(folder / DESIGN)
    config, log = (_text_or_nothing(folder / name) for name in (CONFIG, LOG))
    return run_page(design, config, log, estimates_in(log))


def estimates_in(log: str) -> str:
    """Give the lines of a log that name what no source gives."""
    _, _, after = log.partition(ESTIMATES + "\n")
    lines: list[str] = []
    for line in after.splitlines():
        if not line.startswith("  "):
            break
        lines.append(line.strip())
    return "\n".join(lines)


def _text_or_nothing(file: Path) -> str:
    return read_text(file) if file.is_file() else ""
