"""A bound as plain data and back."""

from typing import Any

import pytest

from multilens.bounds.bound import Bound
from multilens.bounds.record import bound_record, read_bound

PROVED = Bound(1.25, "", 1.0, 17)


@pytest.mark.parametrize("bound", [PROVED, Bound(None, "no bound is known", None, 0)], ids=["proved", "unknown"])
def test_a_bound_comes_back(bound: Bound):
    assert read_bound(bound_record(bound), "bound") == bound


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"value": "1"}, "bound.value must be a number, got '1'"),
        ({"boxes": 1.5}, "bound.boxes must be a whole number, got 1.5"),
        ({"reason": None}, "bound.reason must be a text, got None"),
        ({"proof": 1}, "bound must have the keys value, reason, root, boxes, got the unknown key 'proof'"),
    ],
)
def test_what_is_no_bound_is_refused_by_its_key(changed: dict[str, Any], told: str):
    with pytest.raises(ValueError, match=f"^{told}$"):
        read_bound(bound_record(PROVED) | changed, "bound")
