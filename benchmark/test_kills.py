from pathlib import Path

import pytest

from benchmark.kills import BEFORE, killed_sweep

SMALL = (
    "back=rectangle",
    "depth.count=8",
    "search.starts=2",
    "search.patience=0",
    "search.proof=1",
    "lenses.count=1,2,3",
    "back.outline.width=60,70",
)


@pytest.mark.timeout(600)
def test_a_sweep_that_is_killed_and_run_again_ends_as_if_nothing_had_happened(tmp_path: Path) -> None:
    outcome = killed_sweep(tmp_path, kills=3, seed=1, sweep=SMALL)
    assert outcome.jobs == 6
    assert sum(outcome.during.values()) == 3
    assert outcome.during[BEFORE] >= 1
    assert outcome.computed_again == ()
    assert outcome.different == ()
