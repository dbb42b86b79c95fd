"""Files and folders that are written whole or not at all, and the record of what made them."""

import itertools
import os
import platform
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from secrets import token_hex

ESTIMATES = "estimates, which no source gives:"
"""Line of a log after which they come, a line each, indented."""

AT_ONCE = 8
"""Files of a folder that are flushed together."""

LIBRARIES = ("multilens", "torch", "numpy", "scipy", "shapely", "hydra-core")


@dataclass(frozen=True)
class Origin:
    """What made a design: enough to make it again.

    Args:
        seed: of the starts.
        starts: how many fresh layouts it began with.
        patience: waves without progress after which it ended.
        penalty: name of the penalty.
        time_limit: s, or None.
        versions: of Python and the libraries.
        commit: of the source, with a "+" if it was changed since; None where unknown.
        known: how many layouts it began with besides that were known.
    """

    seed: int
    starts: int
    patience: int
    penalty: str
    time_limit: float | None
    versions: dict[str, str] = field(default_factory=dict)
    commit: str | None = None
    known: int = 0


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file, text in UTF-8, complete or not at all, whatever interrupts: beside its place, flushed, then renamed.

    Raises:
        OSError: the folder cannot be written or is full; nothing is left behind then, and what was there before stays.
    """
    beside = _beside(path)
    try:
        beside.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
        _flush(beside)
        os.replace(beside, path)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise


@contextmanager
def scratch_folder(folder: Path) -> Iterator[Path]:
    """Give an empty hidden folder beside another, to be emptied by renames; it and what is still in it vanish in the end.

    Raises:
        OSError: the parent of the folder is missing or cannot be written.
    """
    beside = _beside(folder)
    beside.mkdir()
    try:
        yield beside
    finally:
        shutil.rmtree(beside, ignore_errors=True)


@contextmanager
def folder_written_whole(folder: Path) -> Iterator[Path]:
    """Give an empty folder to fill, which becomes `folder` when the block ends well and vanishes when it does not.

    Args:
        folder: where it goes; may be there already if it is empty. Its parent must exist.

    Raises:
        FileExistsError: something is there already.
        OSError: the parent is missing, cannot be written or is full; nothing is left behind then.
    """
    folder = folder.resolve()
    _refuse_unless_free(folder)
    with scratch_folder(folder) as beside:
        yield beside
        with ThreadPoolExecutor(AT_ONCE) as flushing:
            # A disk that is asked for several at once takes hardly longer than for one; the list raises what one of them raised.
            list(flushing.map(_flush, sorted(beside.rglob("*"))))
        _flush(beside)
        try:
            os.replace(beside, folder)
        except OSError:
            # Somebody else may have filled it meanwhile: then that is what is wrong.
            _refuse_unless_free(folder)
            raise


def holds_something(path: Path) -> bool:
    """Say whether there is a file at a path, or a folder that is not empty; one that vanishes meanwhile holds nothing."""
    try:
        return any(path.iterdir())
    except FileNotFoundError:
        return False
    except NotADirectoryError:
        return True


def set_aside(path: Path) -> Path:
    """Rename what is damaged to NAME.damaged, or NAME.damaged-2 and so on, and give the new path.

    Raises:
        OSError: it cannot be renamed.
    """
    names = (path.with_name(f"{path.name}.damaged{f'-{count}' if count > 1 else ''}") for count in itertools.count(1))
    free = next(name for name in names if not name.exists())
    path.rename(free)
    return free


def versions() -> dict[str, str]:
    """Give the version of Python and of every library that a result depends on."""
    return {"python": platform.python_version()} | {name: _version(name) for name in LIBRARIES}


@cache
def made_with() -> dict[str, str]:
    """Give the versions, and a checksum of the source of multilens: where all of it is the same, results are the same to the byte.

    The commit would say too much, as when a page is written, and too little where a file was changed since.
    """
    package = Path(__file__).parent
    source = sha256()
    for module in sorted(package.rglob("*.py")):
        source.update(f"{module.relative_to(package).as_posix()}\n".encode() + module.read_bytes())
    return versions() | {"source": source.hexdigest()[:16]}


@cache
def _version(name: str) -> str:
    # What is loaded stays what it is, and looking it up takes longer than a small search may.
    return version(name)


@cache
def source_commit() -> str | None:
    """Give the commit of the checkout this code runs from, with a "+" if it was changed since; None outside a checkout.

    Told as it was when first asked: later changes are not in the code that is running.
    """
    here = Path(__file__).resolve().parents[2]
    if not (here / ".git").exists():
        return None
    status = ["git", "-C", str(here), "status", "--porcelain=v2", "--branch", "--untracked-files=no"]
    try:
        lines = subprocess.run(status, capture_output=True, text=True, check=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        return None
    commit = next((line.split()[2] for line in lines if line.startswith("# branch.oid ")), "(initial)")
    if commit == "(initial)":
        return None
    return commit + ("+" if any(not line.startswith("#") for line in lines) else "")


def _refuse_unless_free(folder: Path) -> None:
    if holds_something(folder):
        raise FileExistsError(f"folder must be new or empty, got {folder}")


def _beside(path: Path) -> Path:
    """Give a hidden name of its own next to a path, on the same file system, so that a rename is one step."""
    return path.with_name(f".{path.name}.partial-{token_hex(4)}")


def _flush(path: Path) -> None:
    """Wait until what was written has reached the disk, which is where a full one or a broken one shows."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
