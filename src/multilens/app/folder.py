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


def write_folder(folder: Path, design: "Design", config_text: str, log_text: str) -> None:
    """Write a run folder and print the paths of its files.

    Raises:
        OSError: it cannot be written.
    """
    from multilens.runs import write_run

    folder.parent.mkdir(parents=True, exist_ok=True)
    write_run(folder, design, config_text, log_text)
    print()
    for path in sorted(folder.iterdir()):
        print(path)
