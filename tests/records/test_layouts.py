"""Layouts and certificates to a file and back."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.certificate import Certificate, Clearance
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.records import certificate_record, layout_record, read_certificate, read_layout


def through_json(value):
    """What a file gives back."""
    return json.loads(json.dumps(value, allow_nan=False))


lengths = st.floats(1e-3, 1e3)
coordinates = st.floats(-1e5, 1e5)
lenses = st.integers(1, 4).map(lambda tiers: Lens(5.0, (1.0, 2.0), tiers=tiers))


@st.composite
def layouts(draw, given_lenses):
    most = max(lens.tiers for lens in given_lenses)
    foci = [draw(st.lists(lengths, min_size=lens.tiers, max_size=lens.tiers)) for lens in given_lenses]
    return Layout(
        [[draw(coordinates), draw(coordinates)] for _ in given_lenses],
        [draw(lengths) for _ in given_lenses],
        [own + own[:1] * (most - len(own)) for own in foci],
    )


@given(st.data())
def test_a_layout_comes_back_to_the_bit(data):
    given_lenses = data.draw(st.lists(lenses, min_size=1, max_size=5))
    layout = data.draw(layouts(given_lenses))
    again = read_layout(through_json(layout_record(layout, given_lenses)), "layout", given_lenses)
    for name in ("position", "aperture_radius", "focus"):
        before, after = getattr(layout, name), getattr(again, name)
        assert before.dtype == after.dtype
        assert before.numpy().tobytes() == after.numpy().tobytes()


def test_a_lens_of_fewer_tiers_stores_its_own_foci_alone():
    two = [Lens(5, (1, 2)), Lens(5, (1, 2), tiers=2)]
    rows = layout_record(Layout([[0, 0], [9, 0]], [1, 1], [[300, 300], [400, 500]]), two)
    assert [row["focus"] for row in rows] == [[300.0], [400.0, 500.0]]


@pytest.mark.parametrize(
    ("layout", "message"),
    [
        (Layout([[[0, 0]]], [[1]], [[300]]), r"^layout must be a single one, got a batch of the shape \[1\]$"),
        (Layout([[0, 0], [9, 0]], [1, 1], [300, 300]), "^layout must have 1 lenses, got 2$"),
        (Layout([[0, 0]], [1], [300]), "^focus must have a place for 2 tiers, got 1$"),
    ],
)
def test_a_layout_of_another_form_is_refused(layout, message):
    with pytest.raises(ValueError, match=message):
        layout_record(layout, [Lens(5, (1, 2), tiers=2)])


def test_a_certificate_comes_back():
    certificate = Certificate((Clearance("lens 1 to flash", 0.1 + 0.2, True), Clearance("lens 1", -1e-300, False)))
    assert read_certificate(through_json(certificate_record(certificate)), "certificate") == certificate
