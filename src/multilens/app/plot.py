"""`multilens plot`: the pictures of what was saved, drawn again."""

from collections.abc import Sequence
from pathlib import Path

from multilens.app.ending import DONE
from multilens.app.refusal import RefusedError

USAGE = """\
multilens plot RUN_FOLDER      draw the pictures of a saved run again
multilens plot SWEEP_FOLDER    draw those of a sweep again

Those of a run are drawn from its design.json alone, those of a sweep from its jobs' rows and designs; nothing else is touched. The
paths of the pictures are printed.

Examples
  multilens plot runs/demo/2026-11-22_04-38-31
  multilens plot sweeps/camera_count"""


def plot_command(words: Sequence[str]) -> int:
    """Draw the pictures of a run again from its design alone, or those of a sweep from its table, and print their paths.

    Args:
        words: the folder of the run or of the sweep.

    Returns:
        The exit code.

    Raises:
        RefusedError: there is no such folder, or what is in it is damaged.
        OSError: the pictures cannot be written.
    """
    if len(words) != 1 or words[0].startswith("-"):
        raise RefusedError(
            "plot must be given one folder of a run or of a sweep, as in multilens plot runs/demo, "
            f"got {' '.join(words) or 'none'}"
        )
    folder = Path(words[0])
    is_run = (folder / "design.json").is_file()
    if not (is_run or any(folder.glob("*/row.json"))):
        raise RefusedError(
            f"plot: {folder} must be the folder of a run that found a design or of a sweep, "
            "there is neither design.json in it nor row.json in a folder of it"
        )
    from multilens.app.loading import load_torch

    load_torch()
    for path in _redrawn_run(folder) if is_run else _redrawn_sweep(folder):
        print(path)
    return DONE


def _redrawn_run(folder: Path) -> list[Path]:
    from multilens.app.busy import busy
    from multilens.runs import redraw

    try:
        with busy("drawing the pictures"):
            redraw(folder)
    except ValueError as error:
        raise RefusedError(f"plot: {error}") from None
    return sorted([*folder.glob("*.svg"), *folder.glob("*.png")])


def _redrawn_sweep(folder: Path) -> list[Path]:
    from multilens.app.busy import busy
    from multilens.sweeps.pictures import draw_pictures

    with busy("drawing the pictures"):
        pictures = [folder / picture.name for picture in draw_pictures(folder)]
    if not pictures:
        raise RefusedError(
            f"plot: {folder} must be the folder of a sweep that found a design, none of its jobs has one"
        )
    return pictures
