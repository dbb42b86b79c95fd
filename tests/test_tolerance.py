import pytest

from multilens.tolerance import Tolerance


@pytest.mark.parametrize(
    ("tolerance", "words"),
    [
        (Tolerance(mm=5), "5 mm"),
        (Tolerance(percent=1.5), "1.5 % of the depth"),
        (Tolerance(mm=5, percent=1), "5 mm and 1 % of the depth"),
    ],
)
def test_a_tolerance_in_words(tolerance: Tolerance, words: str):
    assert str(tolerance) == words


@pytest.mark.parametrize(
    ("limits", "told"),
    [
        ({}, "tolerance must have mm, percent or both, got neither"),
        ({"mm": 0}, "mm must be > 0 and finite, got 0"),
        ({"percent": float("inf")}, "percent must be > 0 and finite, got inf"),
    ],
)
def test_a_limit_out_of_its_range_is_refused(limits: dict[str, float], told: str):
    with pytest.raises(ValueError, match=f"^{told}$"):
        Tolerance(**limits)
