"""Where a command that is no run of Hydra's puts its design: `out=FOLDER`."""

from pathlib import Path
from typing import TYPE_CHECKING

from multilens.app.refusal import RefusedError

if TYPE_CHECKING:
    from multilens.design import Design


def refuse_used(folder: Path) -> None:
    """Refuse a folder that holds something already, before anything is computed."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise RefusedError(f"out must be a new or empty folder, {folder} is a file or holds something already")


def write_folder(folder: Path | None, design: "Design", config_text: str, log_text: str) -> list[Path]:
    """Write a run folder and give the paths of its files; none without a folder.

    Raises:
        OSError: it cannot be written.
    """
    from multilens.app.busy import busy
    from multilens.runs import write_run

    if folder is None:
        return []
    folder.parent.mkdir(parents=True, exist_ok=True)
    with busy("drawing the pictures"):
        write_run(folder, design, config_text, log_text)
    return sorted(folder.iterdir())
