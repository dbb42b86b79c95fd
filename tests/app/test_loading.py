"""What a process that computes does once it has loaded everything."""

import gc

from joblib import Parallel, delayed

from multilens.app.loading import keep_what_is_loaded


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
