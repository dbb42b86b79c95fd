import pytest

from benchmark.circles import published, row


@pytest.mark.parametrize("count", [2, 3])
def test_the_fewest_circles_are_the_published_packing(count: int) -> None:
    found = row(count, published()[count], limit=1.5)
    # Polished to the end within a second; the published radius has 12 digits.
    assert found[3] < 1e-8
