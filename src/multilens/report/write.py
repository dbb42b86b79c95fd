"""A report of whatever is given: a design, the folder of a run, the folder of a sweep."""

from collections.abc import Callable, Mapping
from pathlib import Path

from multilens.design import Design
from multilens.documents import read_text
from multilens.report.run_page import run_page
from multilens.report.sweep_page import sweep_page, worth_drawing
from multilens.runs import CONFIG, DESIGN, LOG
from multilens.storage import ESTIMATES, write_whole
from multilens.sweep_row import UNREADABLE, SweepRow
from multilens.sweeps.claim import CLAIM_FILE
from multilens.sweeps.locks import write_held
from multilens.sweeps.table import read_rows

REPORT = "report.html"

Listener = Callable[[str], None]


def write_report(
    what: Design | str | Path, path: str | Path | None = None, listener: Listener = lambda words: None
) -> Path:
    """Write one HTML file that tells of a design or a sweep: it needs no other file, no server and no network.

    The same design, or folder, gives the same bytes.

    Args:
        what: a design, or the folder of a run or of a sweep.
        path: of the file, which is replaced if it is there; None puts report.html into the folder.
        listener: told what is being done, where that takes a while.

    Returns:
        The path of the file.

    Raises:
        ValueError: the design is infeasible, a file of the folder is damaged, or there is no folder to put the report into.
        OSError: the folder holds neither a design nor jobs, or something cannot be read or written.
    """
    if isinstance(what, Design):
        if path is None:
            raise ValueError("path must be given for the report of a design, got None")
        text = run_page(what)
    else:
        folder = Path(what)
        text = _page_of_run(folder) if (folder / DESIGN).is_file() else _page_of_sweep(folder, listener)
        path = Path(what) / REPORT if path is None else path
    path = Path(path)
    # Where a sweep goes on it clears away what is half written and not held.
    write = write_held if (path.parent / CLAIM_FILE).is_file() else write_whole
    write(path, text)
    return path


def _page_of_run(folder: Path) -> str:
    design = Design.load(folder / DESIGN)
    config, log = (_text_or_nothing(folder / name) for name in (CONFIG, LOG))
    return run_page(design, config, log, estimates_in(log))


def _page_of_sweep(folder: Path, listener: Listener) -> str:
    rows = read_rows(folder)
    if not rows:
        raise FileNotFoundError(f"folder must hold a design.json or the jobs of a sweep, {folder} holds neither")
    designs: dict[int, Design] = {}
    unreadable: dict[int, str] = {}
    drawn = worth_drawing(rows)
    for read, row in enumerate(drawn):
        listener(f"reading designs: {read} of {len(drawn)}")
        try:
            designs[row.job] = Design.load(folder / str(row.job) / DESIGN)
        except (ValueError, OSError) as error:
            unreadable[row.job] = str(error).replace(f"{folder / str(row.job)}/", "")
    listener("drawing charts and layouts")
    return sweep_page([_marked(row, unreadable) for row in rows], designs)


def _marked(row: SweepRow, unreadable: Mapping[int, str]) -> SweepRow:
    """Give a row as one without a design where its design cannot be read."""
    return SweepRow(row.job, row.settings, UNREADABLE, unreadable[row.job]) if row.job in unreadable else row


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
