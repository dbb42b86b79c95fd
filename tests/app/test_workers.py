"""The processes that a sweep has for its jobs: where they are, how many threads they have, and when they end."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hydra_plugins.hydra_joblib_launcher.config import JobLibLauncherConf
from joblib import Parallel, delayed
from joblib.externals.loky import get_reusable_executor
from omegaconf import OmegaConf

from multilens.app.loading import load_torch
from multilens.app.workers import THREADS, computing_as, end_workers, prepare_workers

SWEEP_OF_TWO_SLEEPERS = """
import os, sys, time
from joblib import Parallel, delayed
from multilens.app.workers import end_with_parent

def job():
    end_with_parent()
    print(os.getpid(), flush=True)
    time.sleep(600)

Parallel(n_jobs=2)([delayed(job)() for _ in range(2)])
"""


@pytest.fixture(autouse=True)
def _no_worker_is_left():
    yield
    end_workers()


def threads_of_a_worker() -> tuple[int, list[int]]:
    load_torch()
    import scipy.optimize  # noqa: F401
    import torch
    from threadpoolctl import threadpool_info

    pools: list[dict[str, Any]] = threadpool_info()
    return torch.get_num_threads(), [pool["num_threads"] for pool in pools]


def test_a_worker_computes_with_one_thread_whatever_the_machine_has(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in THREADS:
        monkeypatch.setenv(name, "4")
    prepare_workers()
    ((torch, pools),) = Parallel(n_jobs=2)([delayed(threads_of_a_worker)()])
    assert torch == 1
    assert pools
    assert set(pools) == {1}
    assert {os.environ[name] for name in THREADS} == {"1"}


def test_a_worker_is_where_its_sweep_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def here() -> Path:
        prepare_workers()
        return Parallel(n_jobs=2)([delayed(Path.cwd)()])[0]

    assert here() == Path.cwd()
    monkeypatch.chdir(tmp_path)
    assert here() == tmp_path


def test_what_follows_the_jobs_is_computed_by_the_workers_that_computed_them() -> None:
    launcher = OmegaConf.structured(JobLibLauncherConf(n_jobs=2))
    settings: dict[str, Any] = {key: value for key, value in launcher.items() if key != "_target_"}
    prepare_workers()
    # As Hydra's launcher calls it.
    Parallel(**settings | {"backend": "loky"})([delayed(os.getpid)() for _ in range(4)])
    workers = set(get_reusable_executor(reuse=True)._processes)
    assert set(computing_as(launcher)(os.getpid, [()] * 4)) <= workers


@pytest.mark.parametrize("settings", [{"max_nbytes": "1000000"}, {}])
def test_settings_are_taken_as_hydra_takes_them_and_may_be_left_out(settings: dict[str, Any]) -> None:
    launcher = OmegaConf.create({"_target_": JobLibLauncherConf._target_, "n_jobs": 2} | settings)
    assert list(computing_as(launcher)(max, [(1, 2), (3, 0)])) == [2, 3]


def test_workers_are_ended_without_letting_go_of_their_libraries_first() -> None:
    prepare_workers()
    Parallel(n_jobs=2)([delayed(load_torch)() for _ in range(2)])
    executor = get_reusable_executor(reuse=True)
    end_workers()
    assert executor._flags.kill_workers


@pytest.mark.skipif(os.name != "posix", reason="elsewhere a process does not learn that its parent is gone")
@pytest.mark.timeout(30)
def test_workers_of_a_sweep_that_was_killed_end_soon() -> None:
    command = [sys.executable, "-c", SWEEP_OF_TWO_SLEEPERS]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as sweep:
        assert sweep.stdout is not None
        begun = [sweep.stdout.readline() for _ in range(2)]
        sweep.kill()
        # The pipe ends when nobody is left who could write into it.
        assert sweep.stdout.read() == ""
    assert all(begun)
