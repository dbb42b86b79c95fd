"""`multilens animate`: how a search came to a saved design, as a moving picture."""

from collections.abc import Sequence
from pathlib import Path

from multilens.app.busy import busy
from multilens.app.ending import DONE
from multilens.app.loading import load_torch
from multilens.app.refusal import RefusedError, one_line

USAGE = """\
multilens animate RUN_FOLDER    an animated GIF: lenses settle on the back while their error falls

Up to 64 fresh starts of the search are settled once more from its seed, which is quick, and the design is shown at the end. The
path of the file is printed.

Options
  out=FILE.gif             where it goes (search.gif in the folder); a file that is there is replaced

Examples
  multilens animate runs/demo
  multilens animate runs/demo out=search.gif"""

OUT, NAME, MOST_STARTS = "out", "search.gif", 64


def animate_command(words: Sequence[str]) -> int:
    """Draw the animation of a run and print its path.

    Args:
        words: the folder of the run, and `out=FILE.gif`.

    Returns:
        The exit code.

    Raises:
        RefusedError: there is no such folder, what is in it is damaged, or its design was not searched for from fresh starts.
        OSError: the file cannot be written.
    """
    folder, out = _sorted_words(words)
    load_torch()
    from multilens.design import Design
    from multilens.plot.animation import animated_search
    from multilens.search.replay import replay
    from multilens.storage import write_whole

    try:
        design = Design.load(folder / "design.json")
    except ValueError as error:
        raise RefusedError(f"animate: {one_line(str(error))}") from None
    if design.origin is None or not design.origin.starts:
        raise RefusedError(f"animate: {folder} must hold a design that was searched for from fresh starts, it does not")
    question, found, origin = design.problem, design.layout, design.origin
    with busy("settling the starts once more") as say:
        again = replay(question, found, min(origin.starts, MOST_STARTS), origin.seed)

        def told(drawn: int, of: int) -> None:
            say(f"drawing picture {drawn + 1} of {of}")

        content = animated_search(question, again.layouts, again.scores, again.chosen, found, told)
    write_whole(out, content)
    print(out)
    return DONE


def _sorted_words(words: Sequence[str]) -> tuple[Path, Path]:
    """Give the folder and the file to write."""
    outs = [word.partition("=")[2] for word in words if word.partition("=")[0] == OUT]
    folders = [word for word in words if word.partition("=")[0] != OUT]
    if len(folders) != 1 or folders[0].startswith("-"):
        got = " ".join(folders) or "none"
        raise RefusedError(f"animate must be given one run folder, as in multilens animate runs/demo, got {got}")
    if len(outs) > 1 or not all(out.lower().endswith(".gif") for out in outs):
        raise RefusedError(
            f"out must be one file that ends in .gif, as in out=search.gif, got {' '.join(outs) or 'none'}"
        )
    folder = Path(folders[0])
    if not (folder / "design.json").is_file():
        raise RefusedError(
            f"animate: {folder} must be the folder of a run that found a design, there is no design.json in it"
        )
    return folder, Path(outs[0]) if outs else folder / NAME
