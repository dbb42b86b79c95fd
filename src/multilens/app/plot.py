"""`multilens plot`: the pictures of what was saved, drawn again."""

from collections.abc import Sequence
from pathlib import Path

from multilens.app.ending import DONE
from multilens.app.refusal import RefusedError


def plot_command(words: Sequence[str]) -> int:
    """Draw the pictures of a run again from its design alone, and print their paths.

    Args:
        words: the folder of the run.

    Returns:
        The exit code.

    Raises:
        RefusedError: there is no such folder, or what is in it is damaged.
        OSError: the pictures cannot be written.
    """
    if len(words) != 1 or words[0].startswith("-"):
        raise RefusedError(
            f"plot must be given one run folder, as in multilens plot runs/demo, got {' '.join(words) or 'none'}"
        )
    folder = Path(words[0])
    if not (folder / "design.json").is_file():
        raise RefusedError(
            f"plot: {folder} must be the folder of a run that found a design, there is no design.json in it"
        )
    from multilens.app.loading import load_torch

    load_torch()
    from multilens.runs import redraw

    try:
        redraw(folder)
    except ValueError as error:
        raise RefusedError(f"plot: {error}") from None
    for path in sorted([*folder.glob("*.svg"), *folder.glob("*.png")]):
        print(path)
    return DONE
