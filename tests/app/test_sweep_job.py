"""Sweeps that were interrupted, damaged, changed or shared, from the command line."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from threading import Event, Thread
from time import sleep

import jaxtyping
import pytest

from multilens.app.command import run_command
from multilens.storage import made_with
from multilens.sweeps.locks import held

SMALL = ["back=rectangle", "depth.count=8", "search.starts=2", "search.patience=0", "search.proof=1"]
SWEPT = ["lenses.count=2,3", "back.outline.width=70,5"]
SOLVE = "multilens.search.solve.solve"


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def sweep(monkeypatch: pytest.MonkeyPatch, folder: Path, *given: str) -> int:
    monkeypatch.setattr("multilens.app.sweep.pictures_drawn", lambda *given: True)
    command = ["-m", *SMALL, *(given or SWEPT), f"hydra.sweep.dir={folder}"]
    monkeypatch.setattr("sys.argv", ["multilens", *command])
    return run_command(command)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a sweep that nothing interrupted: two jobs with a design, and two whose lenses cannot fit."""
    folder = tmp_path_factory.mktemp("whole") / "sweep"
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
        assert sweep(monkeypatch, folder) == 3
    return folder


@pytest.fixture
def folder(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "sweep"))


def contents(folder: Path) -> dict[str, object]:
    """Give every file but the locks, which are empty, and without the times."""
    files = {str(path.relative_to(folder)): path for path in sorted(folder.rglob("*")) if path.is_file()}
    found: dict[str, object] = {name: path.read_bytes() for name, path in files.items() if path.suffix != ".lock"}
    rows = [json.loads(line) for line in (folder / "table.jsonl").read_text().splitlines()]
    timed = ("time.json", "table.csv", "table.jsonl", "table.md", "multirun.yaml")
    return {name: text for name, text in found.items() if not name.endswith(timed)} | {
        "rows": [{key: value for key, value in row.items() if key != "time_s"} for row in rows]
    }


@pytest.fixture
def computed(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Note each search of a job by its count of lenses."""
    # Loaded before, it keeps its own: what neighbours' layouts lead to is no search of a job.
    import multilens.sweeps.agree
    from multilens.search.solve import solve

    assert multilens.sweeps.agree.solve is solve

    counts: list[int] = []

    def noted(problem, **given):
        counts.append(len(problem.lenses))
        return solve(problem, **given)

    monkeypatch.setattr(SOLVE, noted)
    return counts


def test_a_sweep_that_is_complete_computes_nothing_again(folder: Path, whole: Path, monkeypatch, computed) -> None:
    assert sweep(monkeypatch, folder) == 3
    assert computed == []
    assert contents(folder) == contents(whole)
    assert (folder / "table.csv").read_bytes() == (whole / "table.csv").read_bytes()


def test_only_what_is_missing_is_computed_and_is_the_same_to_the_byte(folder, whole, monkeypatch, computed) -> None:
    shutil.rmtree(folder / "2")
    shutil.rmtree(folder / "3")
    assert sweep(monkeypatch, folder) == 3
    assert computed == [3, 3]
    assert contents(folder) == contents(whole)


@pytest.mark.parametrize(
    ("file", "damage", "told"),
    [
        ("design.json", lambda text: text[: len(text) // 2], "design.json was altered"),
        ("config.yaml", lambda text: text.replace("near", "next"), "config.yaml was altered"),
        ("row.json", lambda text: text.replace("complete", "Complete"), "checksum"),
        ("row.json", None, "row.json is missing"),
        ("layout.csv", None, "layout.csv is missing"),
    ],
)
def test_what_is_damaged_is_set_aside_and_computed_again(
    file, damage, told, folder: Path, whole: Path, monkeypatch, capsys
) -> None:
    path = folder / "0" / file
    path.unlink() if damage is None else path.write_text(damage(path.read_text()))
    assert sweep(monkeypatch, folder) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{folder / '0'}: {told}" in line
    assert "set aside as 0.damaged, computed again" in line
    assert (folder / "0.damaged").is_dir()
    shutil.rmtree(folder / "0.damaged")
    assert contents(folder) == contents(whole)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["lenses.count=2,3", "back.outline.width=70,5", "depth.count=9"], "depth.count was 8 there and is 9 now"),
        (["lenses.count=2,4", "back.outline.width=70,5"], "lenses.count was 2,3 there and is 2,4 now"),
        (["lenses.count=2,3", "back.outline.width=70"], "back.outline.width was 70,5 there"),
    ],
)
def test_another_sweep_in_the_same_folder_is_refused(given, told, folder, whole, monkeypatch, capsys) -> None:
    assert sweep(monkeypatch, folder, *given) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("multilens: hydra.sweep.dir: ")
    assert "holds another sweep: " in line
    assert told in line
    assert contents(folder) == contents(whole)


def test_other_versions_in_the_same_folder_are_refused(folder: Path, whole: Path, monkeypatch, capsys) -> None:
    other = made_with() | {"torch": "1.0"}
    monkeypatch.setattr("multilens.app.sweep_folder.made_with", lambda: other)
    assert sweep(monkeypatch, folder) == 2
    assert f"torch was {made_with()['torch']} there and is 1.0 now" in capsys.readouterr().err
    assert contents(folder) == contents(whole)


def test_a_preset_that_was_edited_is_refused(tmp_path: Path, monkeypatch, capsys) -> None:
    preset = tmp_path / "mine" / "depth" / "desk.yaml"
    preset.parent.mkdir(parents=True)
    command = [
        "-m",
        f"--config-dir={tmp_path / 'mine'}",
        *SMALL,
        "depth=room,desk",
        f"hydra.sweep.dir={tmp_path / 's'}",
    ]
    monkeypatch.setattr("sys.argv", ["multilens", *command])
    preset.write_text("near: 400\nfar: 900\n")
    assert run_command(command) == 0
    preset.write_text("near: 400\nfar: 950\n")
    assert run_command(command) == 2
    assert "depth=desk stands for something else now" in capsys.readouterr().err


def test_where_nothing_says_whose_the_folder_is_each_job_does(folder: Path, monkeypatch, capsys) -> None:
    (folder / "sweep.json").write_text("{}")
    assert sweep(monkeypatch, folder, *SWEPT, "depth.count=9") == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first.endswith("set aside as sweep.json.damaged")
    assert "0 holds another job: depth.count was 8 there and is 9 now" in second


def test_a_job_that_failed_by_a_fault_is_tried_again(tmp_path: Path, monkeypatch, capsys) -> None:
    def fault(problem, **given):
        raise ZeroDivisionError("by no fault of yours")

    with monkeypatch.context() as here:
        here.setattr(SOLVE, fault)
        assert sweep(here, tmp_path / "s", "lenses.count=2,3") == 3
    rows = [json.loads(line) for line in (tmp_path / "s" / "table.jsonl").read_text().splitlines()]
    assert [(row["status"], row["reason"]) for row in rows] == 2 * [
        ("failed", "ZeroDivisionError: by no fault of yours")
    ]
    assert "Traceback" in (tmp_path / "s" / "0" / "run.log").read_text()
    assert sweep(monkeypatch, tmp_path / "s", "lenses.count=2,3") == 0


@pytest.mark.parametrize("faulty", ["multilens.app.sweep_job.row_of", "multilens.runs.write_design"])
def test_a_fault_once_a_design_is_found_leaves_a_row_as_well(faulty: str, tmp_path: Path, monkeypatch) -> None:
    def fault(*given):
        raise ZeroDivisionError("by no fault of yours")

    monkeypatch.setattr(faulty, fault)
    assert sweep(monkeypatch, tmp_path / "s", "lenses.count=2,3") == 3
    rows = [json.loads(line) for line in (tmp_path / "s" / "table.jsonl").read_text().splitlines()]
    assert [(row["status"], row["reason"]) for row in rows] == 2 * [
        ("failed", "ZeroDivisionError: by no fault of yours")
    ]
    assert not list((tmp_path / "s").glob("*/design.json"))


def test_a_fault_while_neighbours_agree_leaves_the_table(folder: Path, monkeypatch, capsys) -> None:
    def fault(*given):
        raise KeyError(7)

    monkeypatch.setattr("multilens.sweeps.agreement.agree_in", fault)
    assert sweep(monkeypatch, folder) == 1
    out, err = capsys.readouterr()
    assert err == "multilens: neighbours cannot agree: KeyError: 7\n"
    assert str(folder / "table.csv") in out


def test_a_fault_at_the_end_of_a_sweep_is_told_in_one_line(folder: Path, monkeypatch, capsys) -> None:
    def fault(*given):
        raise KeyError("rows")

    monkeypatch.setattr("multilens.sweeps.table.write_tables", fault)
    assert sweep(monkeypatch, folder) == 1
    assert capsys.readouterr().err == "multilens: KeyError: 'rows'\n"


def test_a_job_is_the_same_whatever_the_commit(folder: Path, whole: Path, monkeypatch) -> None:
    shutil.rmtree(folder / "0")
    monkeypatch.setattr("multilens.search.solve.source_commit", lambda: "0123abc+")
    assert sweep(monkeypatch, folder) == 3
    assert contents(folder) == contents(whole)


def test_after_a_full_disk_the_rest_is_computed(tmp_path: Path, whole: Path, monkeypatch, computed, capsys) -> None:
    def fills_up(folder, design):
        if design.layout.count == 3:
            raise OSError(28, "No space left on device")
        write(folder, design)

    from multilens.runs import write_design as write

    with monkeypatch.context() as here:
        here.setattr("multilens.runs.write_design", fills_up)
        assert sweep(here, tmp_path / "s") == 1
    assert capsys.readouterr().err == "multilens: [Errno 28] No space left on device\n"
    assert computed == [2, 2, 3]
    assert sweep(monkeypatch, tmp_path / "s") == 3
    assert computed[3:] == [3, 3]
    assert contents(tmp_path / "s") == contents(whole)


def test_a_job_that_somebody_else_computes_is_waited_for_and_computed_when_he_is_gone(
    tmp_path: Path, whole: Path, monkeypatch, capsys
) -> None:
    folder, holding = tmp_path / "s", Event()
    folder.mkdir()

    def hold_until_somebody_waits() -> None:
        with held(folder, "0"):
            holding.set()
            while not (folder / "waiting-0.yaml").exists():
                sleep(0.01)

    other = Thread(target=hold_until_somebody_waits)
    other.start()
    holding.wait()
    assert sweep(monkeypatch, folder) == 3
    other.join()
    out = capsys.readouterr().out
    assert f"{folder}/0: somebody else is computing it" in out
    assert out.index(f"{folder}/3: ") < out.index(f"{folder}/0: lenses.count=2")
    assert contents(folder) == contents(whole)


def test_workers_find_what_one_process_finds(tmp_path: Path, whole: Path, monkeypatch) -> None:
    launcher = ["hydra/launcher=joblib", "hydra.launcher.n_jobs=2"]
    assert sweep(monkeypatch, tmp_path / "s", *SWEPT, *launcher) == 3
    assert contents(tmp_path / "s") == contents(whole)


def test_two_sweeps_in_one_folder_compute_each_job_once(tmp_path: Path) -> None:
    words = ["-m", *SMALL, "lenses.count=2,3", "search.seed=0,1,2", f"hydra.sweep.dir={tmp_path / 's'}"]
    command = [sys.executable, "-c", "from multilens.app import main; main()", *words]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    told = "".join(process.communicate(timeout=200)[0] for process in both)
    assert [process.returncode for process in both] == [0, 0]
    computed = sorted(line.split("/")[-1][0] for line in told.splitlines() if ": lenses.count=" in line)
    assert computed == list("012345")


def test_what_a_kill_left_half_written_is_cleared_away(folder: Path, whole: Path, monkeypatch) -> None:
    (folder / ".1.partial-0badcafe").mkdir()
    (folder / ".1.partial-0badcafe" / "design.json").write_text("{")
    (folder / ".table.csv.partial-0badcafe").write_text("job")
    assert sweep(monkeypatch, folder) == 3
    assert contents(folder) == contents(whole)


@pytest.fixture
def below(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_same_command_finds_its_folder_again(below: Path, monkeypatch, computed, capsys) -> None:
    for given in (["lenses.count=2,3"], ["lenses.count=2,3"], ["lenses.count=2,4"]):
        command = ["-m", *SMALL, "name=mine", *given]
        monkeypatch.setattr("sys.argv", ["multilens", *command])
        assert run_command(command) == 0
    assert len(list((below / "sweeps" / "mine").iterdir())) == 2
    assert "2 jobs are there from before" in capsys.readouterr().out
    assert computed == [2, 3, 2, 4]


def test_only_jobs_are_counted_and_one_is_called_a_job(below: Path, monkeypatch, capsys) -> None:
    folder = below / "one"
    assert sweep(monkeypatch, folder, "lenses.count=2,3") == 0
    shutil.copytree(folder / "1", folder / "1.damaged")
    shutil.rmtree(folder / "1")
    capsys.readouterr()
    assert sweep(monkeypatch, folder, "lenses.count=2,3") == 0
    assert f"{folder}: 1 job is there from before\n" in capsys.readouterr().out


def test_a_job_that_changes_no_key_is_told_without_any(below: Path, monkeypatch, capsys) -> None:
    assert sweep(monkeypatch, below / "one", "lenses.count=2") == 0
    assert "one/0: RMSE" in capsys.readouterr().out
