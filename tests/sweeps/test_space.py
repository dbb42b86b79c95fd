import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.sweeps.space import Choice, Span, each_end

NUMBERS = st.floats(-1e6, 1e6, allow_subnormal=False)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"low": 3, "high": 3}, "from a number to a larger one, got 3 to 3"),
        ({"low": 5, "high": 2}, "got 5 to 2"),
        ({"low": float("nan"), "high": 2}, "low must be finite, got nan"),
        ({"low": 0, "high": float("inf")}, "high must be finite, got inf"),
        ({"low": 0, "high": 2, "step": 3}, "step must be > 0 and at most 2, got 3"),
        ({"low": 0, "high": 2, "log": True}, "log must begin at a number > 0, got 0"),
        ({"low": 1, "high": 9, "step": 2, "log": True}, "log must have no step, got 2"),
    ],
)
def test_a_bad_span_is_refused(given, told):
    with pytest.raises(ValueError, match=rf"^width: .*{told}"):
        Span("width", **given)


@pytest.mark.parametrize("values", [(), ("a",), ("a", "b", "a")])
def test_a_bad_choice_is_refused(values):
    with pytest.raises(ValueError, match="depth: must be two or more values, each once"):
        Choice("depth", values)


@given(st.lists(NUMBERS, min_size=3, max_size=3, unique=True))
def test_what_is_written_of_a_number_stays_in_its_span(numbers):
    low, value, high = sorted(numbers)
    written = float(Span("width", low, high).text(value))
    assert low <= written <= high
    assert written == pytest.approx(value, rel=1e-5)


def test_a_number_is_written_shortly():
    assert Span("width", 20, 45).text(33.27163339) == "33.2716"
    assert Span("count", 2, 6, whole=True).text(4.0) == "4"


def test_each_end_is_given_once():
    space = (Span("width", 20, 45), Choice("depth", ("near", "far", "wide")))
    assert list(each_end(space)) == [
        ("", ["width=20", "depth=near"]),
        ("width=45", ["width=45", "depth=near"]),
        ("width=29.55", ["width=29.55", "depth=near"]),
        ("depth=far", ["width=20", "depth=far"]),
        ("depth=wide", ["width=20", "depth=wide"]),
    ]
