"""What a process that computes does once it has loaded everything."""

import gc

import pytest
from joblib import Parallel, delayed

from multilens.app.loading import keep_what_is_loaded, load_torch
from multilens.app.workers import end_workers


@pytest.fixture(autouse=True)
def _workers_are_new():
    end_workers()
    yield
    end_workers()


def set_aside_now_and_later() -> tuple[int, int]:
    before = gc.get_freeze_count()
    keep_what_is_loaded()
    first = gc.get_freeze_count()
    kept = [[] for _ in range(1000)]
    keep_what_is_loaded()
    return first - before, gc.get_freeze_count() - first - len(kept)


def test_the_collector_passes_over_what_is_loaded_and_not_over_what_comes_later():
    ((loaded, later),) = Parallel(n_jobs=2)([delayed(set_aside_now_and_later)()])
    assert loaded > 1000
    assert later < 0


def frozen_and_collecting_after_torch() -> tuple[int, bool]:
    load_torch()
    return gc.get_freeze_count(), gc.isenabled()


def test_the_collector_passes_over_torch_and_works_on():
    ((loaded, works),) = Parallel(n_jobs=2)([delayed(frozen_and_collecting_after_torch)()])
    assert loaded > 100_000
    assert works
