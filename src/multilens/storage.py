"""Files that are written whole or not at all, and the record of what made them."""

import os
import platform
import subprocess
import tempfile
from importlib.metadata import version
from pathlib import Path

LIBRARIES = ("multilens", "torch", "numpy", "scipy", "shapely", "hydra-core")


def write_whole(path: Path, text: str) -> None:
    """Write a text file so that it is there complete or not at all, whatever interrupts: beside it, flushed, then renamed.

    Raises:
        OSError: the folder cannot be written or is full; nothing is left behind then.
    """
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".partial")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(beside, 0o666 & ~_umask())
        os.replace(beside, path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise


def versions() -> dict[str, str]:
    """Give the version of Python and of every library that a result depends on."""
    return {"python": platform.python_version()} | {name: version(name) for name in LIBRARIES}


def source_commit() -> str | None:
    """Give the commit of the checkout this code runs from, with a "+" if it was changed since; None outside a checkout."""
    here = Path(__file__).resolve().parents[2]
    if not (here / ".git").exists():
        return None
    git = ["git", "-C", str(here)]
    try:
        commit = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
        changed = subprocess.run(
            [*git, "status", "--porcelain", "-uno"], capture_output=True, text=True, check=True
        ).stdout
    except (OSError, subprocess.CalledProcessError):
        return None
    return commit + ("+" if changed else "")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
