from pathlib import Path
from time import monotonic, process_time

import jaxtyping
import pytest

from benchmark.sweeps import overhead


def test_the_overhead_and_the_search_are_parts_of_what_the_sweep_took(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    clock, processor = monotonic(), process_time()
    cost = overhead(2, tmp_path)
    assert 0 < 2 * (cost.clock + cost.search) <= monotonic() - clock
    assert 0 < 2 * cost.processor <= process_time() - processor
    assert cost.search > 0
    assert len(list((tmp_path / "all").glob("*/row.json"))) == 2
