import hashlib
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.documents import LARGEST_DOCUMENT, document, document_content, read_text

plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(st.dictionaries(st.text(), plain, max_size=4))
def test_plain_data_come_back_as_they_were(content):
    content = {f"the {key}": value for key, value in content.items()}
    back = document_content(document("some.schema", 1, content), "some.schema", 1)
    # Text tells 1 from 1.0 and 0.0 from -0.0, which equality does not.
    assert json.dumps(back) == json.dumps(content)


def test_the_checksum_is_of_the_canonical_rest():
    written = json.loads(document("some.schema", 1, {"b": [0.1, None], "a": "ü"}))
    canonical = b'{"a":"\\u00fc","b":[0.1,null],"schema":"some.schema","schema_version":1}'
    assert written["checksum"] == "sha256:" + hashlib.sha256(canonical).hexdigest()


def test_numbers_in_a_row_stand_in_one_line():
    assert '  "depths": [1.0, 2.0]\n' in document("some.schema", 1, {"depths": [1.0, 2.0]})


def test_a_number_that_is_not_finite_is_not_written():
    with pytest.raises(ValueError, match="JSON compliant"):
        document("some.schema", 1, {"a": float("nan")})


@pytest.fixture
def text():
    return document("some.schema", 1, {"name": "phone", "numbers": [1.5, 2.5], "more": {"a": [[1], [2]]}})


@pytest.mark.parametrize("part", [0.0, 0.3, 0.6, 0.99])
def test_a_truncated_document_is_refused(text, part):
    with pytest.raises(ValueError, match=r"^must be whole JSON, got .* in line \d+$"):
        document_content(text[: int(part * (len(text) - 2))], "some.schema", 1)


@pytest.mark.parametrize(
    ("old", "new"),
    [("1.5", "1.6"), ("phone", "phon"), ('"name"', '"Name"'), ("sha256:", "sha256:0"), ("2.5]", "2.5, 1]")],
)
def test_an_altered_document_is_refused(text, old, new):
    assert text.count(old) == 1
    with pytest.raises(ValueError, match=r"^checksum must be sha256:[0-9a-f]{64} for this content, got .*altered$"):
        document_content(text.replace(old, new), "some.schema", 1)


@pytest.mark.parametrize(
    ("hostile", "message"),
    [
        ('{"schema": "other"}', r"^schema must be some\.schema, got 'other'$"),
        ('{"schema": "some.schema", "schema_version": 2}', "^schema_version must be 1, got 2$"),
        ('{"schema": "some.schema", "schema_version": true}', "^schema_version must be 1, got True$"),
        ('{"schema": "some.schema", "schema_version": 1}', "^checksum must be .*, got None"),
        ("[" * 100_000, "^must be nested at most 16 deep, got more$"),
        ('{"a":' * 100_000, "^must be nested at most 16 deep, got more$"),
        ("[]", "^must be a JSON record, got a list$"),
        ('{"a": 1, "a": 2}', "^must have each key once, got 'a' twice$"),
        ('{"a": NaN}', "^must hold finite numbers, got NaN$"),
        ('{"a": -Infinity}', "^must hold finite numbers, got -Infinity$"),
        ('{"a": ' + "9" * 5000 + "}", "^Exceeds the limit"),
    ],
)
def test_a_hostile_document_is_refused_in_one_line(hostile, message):
    with pytest.raises(ValueError, match=message) as refusal:
        document_content(hostile, "some.schema", 1)
    assert "\n" not in str(refusal.value)


def test_brackets_in_a_text_are_no_nesting():
    content = {"a": "[" * 100 + '\\"{'}
    assert document_content(document("some.schema", 1, content), "some.schema", 1) == content


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    with (tmp_path / "huge.json").open("wb") as file:
        file.truncate(LARGEST_DOCUMENT + 1)
    with pytest.raises(ValueError, match=r"^must be at most 33554432 bytes, got more$"):
        read_text(tmp_path / "huge.json")


def test_a_file_that_is_not_text_is_refused(tmp_path):
    (tmp_path / "picture.json").write_bytes(b"{\x89PNG")
    with pytest.raises(ValueError, match=r"^must be text in UTF-8, got the byte 0x89 at 1$"):
        read_text(tmp_path / "picture.json")
