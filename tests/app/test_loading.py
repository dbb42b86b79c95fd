"""How many threads a process may have that a sweep has started."""

import os
from typing import Any

import pytest
from joblib import Parallel, delayed

from multilens.app.loading import THREADS, load_torch, one_thread_for_workers


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
    one_thread_for_workers()
    ((torch, pools),) = Parallel(n_jobs=2)([delayed(threads_of_a_worker)()])
    assert torch == 1
    assert pools
    assert set(pools) == {1}
    assert {os.environ[name] for name in THREADS} == {"1"}
