import errno
import os
import stat
import subprocess
from pathlib import Path

import pytest

from multilens import storage
from multilens.storage import folder_written_whole, holds_something, scratch_folder, write_whole


def test_a_file_is_written_as_it_was_given(tmp_path):
    write_whole(tmp_path / "note.txt", "Überschrift\nzwei\n")
    assert (tmp_path / "note.txt").read_bytes() == "Überschrift\nzwei\n".encode()


def test_a_file_that_is_there_is_replaced(tmp_path):
    (tmp_path / "note.txt").write_text("old")
    write_whole(tmp_path / "note.txt", "new")
    assert (tmp_path / "note.txt").read_text() == "new"


@pytest.fixture
def full_disk(monkeypatch):
    def refuse(handle):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", refuse)


def test_a_full_disk_leaves_no_file(tmp_path, full_disk):
    with pytest.raises(OSError, match="No space left"):
        write_whole(tmp_path / "note.txt", "new")
    assert not list(tmp_path.iterdir())


def test_a_full_disk_leaves_the_file_that_was_there(tmp_path, full_disk):
    (tmp_path / "note.txt").write_text("old")
    with pytest.raises(OSError, match="No space left"):
        write_whole(tmp_path / "note.txt", "new")
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"note.txt": "old"}


def test_an_interrupt_before_the_rename_leaves_no_file(tmp_path, monkeypatch):
    def interrupt(source, target):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "note.txt", "new")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("mask", "file_mode", "folder_mode"), [(0o022, 0o644, 0o755), (0o077, 0o600, 0o700)])
def test_files_and_folders_keep_to_the_umask(tmp_path, mask, file_mode, folder_mode):
    before = os.umask(mask)
    try:
        with folder_written_whole(tmp_path / "run") as inside:
            write_whole(inside / "note.txt", "new")
    finally:
        os.umask(before)
    modes = [stat.S_IMODE(path.stat().st_mode) for path in (tmp_path / "run" / "note.txt", tmp_path / "run")]
    assert modes == [file_mode, folder_mode]


def test_a_folder_is_not_there_before_it_is_whole(tmp_path):
    with folder_written_whole(tmp_path / "run") as inside:
        (inside / "note.txt").write_text("new")
        assert not (tmp_path / "run").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_an_empty_folder_is_filled(tmp_path):
    (tmp_path / "run").mkdir()
    with folder_written_whole(tmp_path / "run") as inside:
        (inside / "note.txt").write_text("new")
    assert (tmp_path / "run" / "note.txt").read_text() == "new"


@pytest.mark.parametrize("there", ["file", "folder with a file"])
def test_a_folder_that_holds_something_is_refused_and_kept(tmp_path, there):
    target = tmp_path / "run"
    if there == "file":
        target.write_text("mine")
    else:
        target.mkdir()
        (target / "mine.txt").write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    with (
        pytest.raises(FileExistsError, match=r"^folder must be new or empty, got .*run$"),
        folder_written_whole(target),
    ):
        pass
    assert sorted(tmp_path.rglob("*")) == before


def test_of_two_writers_the_second_is_refused(tmp_path):
    def write_while_another_does(folder: Path) -> None:
        with folder_written_whole(folder) as late:
            (late / "note.txt").write_text("late")
            with folder_written_whole(folder) as early:
                (early / "note.txt").write_text("early")

    with pytest.raises(FileExistsError, match="new or empty"):
        write_while_another_does(tmp_path / "run")
    assert {path.name: path.read_text() for path in tmp_path.glob("*/*")} == {"note.txt": "early"}


@pytest.mark.parametrize("fault", [KeyboardInterrupt, SystemExit, OSError(errno.ENOSPC, "full"), ValueError])
def test_a_folder_that_fails_on_the_way_leaves_nothing(tmp_path, fault):
    def fill(folder: Path) -> None:
        with folder_written_whole(folder) as inside:
            (inside / "note.txt").write_text("new")
            raise fault

    with pytest.raises(fault if isinstance(fault, type) else type(fault)):
        fill(tmp_path / "run")
    assert not list(tmp_path.iterdir())


def test_a_folder_on_a_full_disk_leaves_the_empty_one_that_was_there(tmp_path, full_disk):
    (tmp_path / "run").mkdir()
    with pytest.raises(OSError, match="No space left"), folder_written_whole(tmp_path / "run") as inside:
        (inside / "note.txt").write_text("new")
    assert list(tmp_path.rglob("*")) == [tmp_path / "run"]


def test_a_folder_without_a_parent_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="missing"), folder_written_whole(tmp_path / "missing" / "run"):
        pass


def test_a_link_to_an_empty_folder_is_followed(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "run").symlink_to(tmp_path / "real")
    with folder_written_whole(tmp_path / "run") as inside:
        (inside / "note.txt").write_text("new")
    assert (tmp_path / "real" / "note.txt").read_text() == "new"


def test_a_folder_that_vanishes_while_it_is_looked_at_holds_nothing(tmp_path, monkeypatch):
    (tmp_path / "run").mkdir()
    looked = type(tmp_path).iterdir

    def iterdir(folder):
        folder.rmdir()
        return looked(folder)

    monkeypatch.setattr(type(tmp_path), "iterdir", iterdir)
    assert not holds_something(tmp_path / "run")


def test_files_and_filled_folders_hold_something(tmp_path):
    assert not holds_something(tmp_path)
    (tmp_path / "note.txt").write_text("")
    assert holds_something(tmp_path / "note.txt")
    assert holds_something(tmp_path)
    assert not holds_something(tmp_path / "nowhere")


def test_a_scratch_folder_vanishes_with_what_is_left_in_it(tmp_path):
    with scratch_folder(tmp_path / "run") as scratch:
        (scratch / "note.txt").write_text("new")
    assert not list(tmp_path.iterdir())


def test_commit_is_that_of_the_checkout_and_tells_of_changes(tmp_path, monkeypatch):
    def git(*words: str) -> str:
        who = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
        return subprocess.run(
            ["git", "-C", str(tmp_path), *who, *words], capture_output=True, text=True, check=True
        ).stdout.strip()

    monkeypatch.setattr(storage, "__file__", str(tmp_path / "src" / "multilens" / "storage.py"))
    asked = storage.source_commit.__wrapped__
    told = [asked()]
    git("init", "-q")
    told.append(asked())
    (tmp_path / "code").write_text("old")
    git("add", "code")
    git("commit", "-q", "-m", "first")
    told.append(asked())
    (tmp_path / "note").write_text("not a part of the code")
    told.append(asked())
    (tmp_path / "code").write_text("new")
    told.append(asked())
    commit = git("rev-parse", "HEAD")
    assert told == [None, None, commit, commit, commit + "+"]


def test_every_file_of_a_folder_reaches_the_disk_before_the_folder_is_there(tmp_path, monkeypatch):
    folder, flushed = tmp_path / "run", []

    def flush(handle):
        assert not folder.exists()
        flushed.append(os.fstat(handle).st_ino)

    monkeypatch.setattr(os, "fsync", flush)
    with folder_written_whole(folder) as inside:
        for number in range(20):
            (inside / str(number)).write_text("new")
    assert sorted(flushed) == sorted(path.stat().st_ino for path in [folder, *folder.iterdir()])
