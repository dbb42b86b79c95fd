import pytest

from multilens.cad.units import scale_of


def scale(told: str | None, found: float | None) -> float:
    return scale_of(told, found, "in its head", "units=mm")


def test_a_unit_is_read_or_told():
    assert scale(None, 25.4) == 25.4
    assert scale("inch", None) == 25.4
    assert scale("inch", 25.4) == 25.4


@pytest.mark.parametrize(
    ("told", "found", "message"),
    [
        (None, None, r"units must be known, got a file without them \(in its head\): say which, as in units=mm"),
        (
            "mm",
            25.4,
            r"units must be those of the file, in which 1 is 25.4 mm \(in its head\), or not be given, got mm",
        ),
        ("millimetre", None, "units must be one of mm, cm, m, um, inch, ft, got millimetre"),
        ("in", None, "got in; did you mean inch"),
    ],
)
def test_a_unit_is_never_guessed(told: str | None, found: float | None, message: str):
    with pytest.raises(ValueError, match=message):
        scale(told, found)
