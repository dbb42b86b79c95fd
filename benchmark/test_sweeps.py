from pathlib import Path

import jaxtyping
import pytest

from benchmark.sweeps import overhead


def test_the_overhead_is_what_is_not_the_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    cost = overhead(2, tmp_path)
    assert 0 < cost.processor <= cost.clock * 1.5
    assert cost.search > 0
    assert len(list((tmp_path / "all").glob("*/row.json"))) == 2
