import pytest

from multilens.fields import choice, items, number, numbers, record, text, whole_number, within


def test_a_number_is_the_same_to_the_bit():
    assert number(0.1 + 0.2, "gap").hex() == (0.1 + 0.2).hex()


@pytest.mark.parametrize(
    ("read", "value", "message"),
    [
        (number, "six", "gap must be a number, got 'six'"),
        (number, True, "gap must be a number, got True"),
        (number, None, "gap must be a number, got None"),
        (number, [1.0], "gap must be a number, got a list of 1"),
        (number, float("nan"), "gap must be a finite number, got nan"),
        (number, float("-inf"), "gap must be a finite number, got -inf"),
        (number, 10**400, "gap must be a finite number, got a number too large for a float"),
        (whole_number, 1.0, "gap must be a whole number, got 1.0"),
        (whole_number, False, "gap must be a whole number, got False"),
        (text, 3, "gap must be a text, got 3"),
        (items, {"a": 1}, "gap must be a list, got a record of 1"),
        (numbers, [1.0, "x"], "gap[1] must be a number, got 'x'"),
    ],
)
def test_another_type_is_refused_by_name(read, value, message):
    with pytest.raises(ValueError, match="gap") as refusal:
        read(value, "gap")
    assert str(refusal.value) == message


def test_a_list_of_another_length_is_refused():
    with pytest.raises(ValueError, match=r"^position must be a list of 2, got 3$"):
        items([1, 2, 3], "position", 2)


def test_an_unknown_key_is_refused():
    with pytest.raises(ValueError, match=r"^lens must have the keys gap, tiers, got the unknown key '_target_'$"):
        record({"gap": 1, "tiers": 1, "_target_": "numpy.load"}, "lens", ("gap", "tiers"))


def test_a_record_without_keys_says_so():
    with pytest.raises(ValueError, match=r"^metric must have the keys none, got the unknown key 'of'$"):
        record({"of": 1}, "metric", ())


def test_a_missing_key_is_refused():
    with pytest.raises(ValueError, match=r"^lens must have the keys gap, tiers, got none called tiers$"):
        record({"gap": 1}, "lens", ("gap", "tiers"))


def test_a_choice_that_is_not_allowed_is_refused():
    with pytest.raises(ValueError, match=r"^status must be one of a, b, got 'c'$"):
        choice("c", "status", ("a", "b"))


def test_what_was_found_is_cut_short():
    with pytest.raises(ValueError, match="gap") as refusal:
        number("x" * 10_000, "gap")
    assert len(str(refusal.value)) < 100


def test_a_refusal_inside_gets_the_path_before_it():
    with pytest.raises(ValueError, match=r"^lenses\[0\]: tiers must be >= 1$"), within("lenses[0]"):
        raise ValueError("tiers must be >= 1")
