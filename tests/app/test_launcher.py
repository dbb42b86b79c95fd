"""What a launcher for clusters is refused, and how it fails."""

import os
from pathlib import Path

import pytest
from joblib import Parallel, delayed

from multilens.app.command import run_command
from multilens.app.launcher import failures_told, refuse_foreign_commands

pytest.importorskip("submitit", reason="the extra for clusters is not installed")

FILE = "# @package _global_\ndefaults: [override /hydra/launcher: submitit_slurm]\nhydra: {launcher: {%s}}\n"


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("setup: [make_mischief]", "hydra.launcher.setup runs commands"),
        ('comment: "a\\nmake_mischief"', "hydra.launcher.comment must be on one line"),
        ('additional_parameters: {"a\\nmake_mischief": 1}', "hydra.launcher.additional_parameters must be on one line"),
    ],
)
def test_a_command_in_a_users_file_is_refused(
    given: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine/experiment").mkdir(parents=True)
    (tmp_path / "mine/experiment/x.yaml").write_text(FILE % given)
    assert run_command(["-m", "--config-dir", "mine", "experiment=x"]) == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
    assert {path.name for path in tmp_path.iterdir()} == {"mine"}


@pytest.mark.parametrize("plus", ["", "+", "++"])
def test_a_command_on_the_command_line_is_not_refused(plus: str):
    refuse_foreign_commands({"setup": ["module load python"]}, [f"{plus}hydra.launcher.setup=[module load python]"])


def test_a_machine_without_slurm_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert run_command(["-m", "lenses.count=1,2", "hydra/launcher=submitit_slurm"]) == 2
    assert "must be started where Slurm's commands are" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_sweep_on_no_core_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    assert run_command(["-m", "lenses.count=1,2", "hydra/launcher=joblib", "hydra.launcher.n_jobs=0"]) == 2
    assert "hydra.launcher.n_jobs must be at least 1, or -1" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_worker_that_was_killed_is_told_in_one_line():
    with (
        pytest.raises(OSError, match="a worker was killed, perhaps for want of memory: the same command"),
        failures_told(),
    ):
        Parallel(n_jobs=2)([delayed(os.kill)(0, 0), delayed(os._exit)(9)])


def test_a_node_that_lacks_a_library_is_told_in_one_line():
    with pytest.raises(OSError, match=r"^ModuleNotFoundError: No module named 'torch'$"), failures_told():
        raise ModuleNotFoundError("No module named 'torch'")


def test_a_job_that_was_killed_is_told_in_one_line():
    from submitit.core.utils import UncompletedJobError

    message = "Job 7_1 (task: 0)\nhas not produced any output (state: OUT_OF_MEMORY)\n-----\nslurmstepd: killed\n"
    with pytest.raises(OSError, match=r"^Job 7_1 \(task: 0\): slurmstepd: killed$"), failures_told():
        raise UncompletedJobError(message)
