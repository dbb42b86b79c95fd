"""Any small dataclass to a file and back."""

import json
from dataclasses import dataclass, replace

import pytest

from multilens.records import named_record, noun_record, read_named, read_noun


@dataclass(frozen=True)
class Rim:
    width: float
    parts: int = 1


@dataclass(frozen=True)
class Road:
    pass


@dataclass(frozen=True)
class Wheel:
    side: str
    turns: bool
    rim: Rim
    spokes: tuple[float, ...]
    place: tuple[float | None, float | None] = (None, None)
    spare: Rim | None = None
    grip: Road | Rim | None = None

    def __post_init__(self) -> None:
        if not self.spokes:
            raise ValueError("spokes must be at least one, got none")


WHEEL = Wheel("left", True, Rim(1.5), (1.0, 0.1 + 0.2), (None, 3.0))
TABLE = {"wheel": Wheel, "road": Road}


@pytest.mark.parametrize(
    "noun", [WHEEL, Wheel("", False, Rim(2.0, 3), (1.0,), spare=Rim(9.0), grip=Rim(1.0)), replace(WHEEL, grip=Road())]
)
def test_a_noun_of_every_kind_of_field_comes_back(noun):
    assert read_noun(Wheel, json.loads(json.dumps(noun_record(noun))), "wheel") == noun


def test_what_is_unknown_is_left_out():
    assert "spare" not in noun_record(WHEEL)
    assert noun_record(WHEEL)["place"] == [None, 3.0]


def test_whole_numbers_are_written_as_what_they_are_read_as():
    assert json.dumps(noun_record(Rim(2, 3))) == '{"width": 2.0, "parts": 3}'


def test_a_noun_that_holds_nothing_is_its_name():
    assert named_record(Road(), TABLE, "things") == "road"
    assert read_named(TABLE, "road", "things") == Road()


def test_a_noun_that_holds_something_has_its_name_beside_it():
    written = named_record(WHEEL, TABLE, "things")
    assert isinstance(written, dict)
    assert written["name"] == "wheel"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"turns": 1}, "wheel.turns must be true or false, got 1"),
        ({"rim": {"width": "x", "parts": 1}}, "wheel.rim.width must be a number, got 'x'"),
        ({"rim": {"width": 1.0}}, "wheel.rim must have the keys width, parts, got none called parts"),
        ({"spokes": [1.0, None]}, "wheel.spokes[1] must be a number, got None"),
        ({"place": [1.0]}, "wheel.place must be a list of 2, got 1"),
        ({"spare": 3}, "wheel.spare must be a record with width, parts, got 3"),
        ({"spokes": []}, "wheel: spokes must be at least one, got none"),
        (
            {"_target_": "os.system"},
            "wheel must have the keys side, turns, rim, spokes, place, spare, grip, got the unknown key '_target_'",
        ),
    ],
)
def test_what_is_wrong_is_named_in_one_line(change, message):
    with pytest.raises(ValueError, match="wheel") as refusal:
        read_noun(Wheel, noun_record(WHEEL) | change, "wheel")
    assert str(refusal.value) == message
