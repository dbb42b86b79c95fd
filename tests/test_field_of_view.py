"""Fields: who sees how much, against areas, points counted one by one and hand-worked angles."""

import math

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from multilens import Lens
from multilens.field_of_view import Field, Part


def lens(field_of_view_deg: float | None) -> Lens:
    return Lens(6.0, (0.5, 3.0), field_of_view_deg=field_of_view_deg)


def test_the_edge_is_left_to_those_who_see_so_far():
    field = Field([0.0, 20.0, 50.0], [1.0, 2.0, 1.0])
    assert field.parts([lens(80.0), lens(120.0), lens(24.0)]) == (
        Part((0, 1, 2), 0.25),
        Part((0, 1), 0.5),
        Part((1,), 0.25),
    )


def test_a_lens_sees_to_the_very_edge_of_its_field():
    assert Field([40.0]).parts([lens(80.0)]) == (Part((0,), 1.0),)


def test_where_no_lens_sees_there_is_a_part_without_lenses():
    assert Field([10.0, 70.0]).parts([lens(90.0)]) == (Part((0,), 0.5), Part((), 0.5))


def test_a_lens_of_an_unknown_field_sees_everything():
    assert Field([0.0, 89.0]).parts([lens(None)]) == (Part((0,), 1.0),)


def test_an_angle_without_weight_is_not_asked_for():
    assert Field([10.0, 70.0], [1.0, 0.0]).parts([lens(90.0)]) == (Part((0,), 1.0),)


@given(st.floats(20, 150), st.floats(20, 150), st.integers(1, 40))
def test_the_share_that_a_lens_sees_of_rings_is_that_of_the_area(whole, seen, count):
    parts = Field.rings(whole, count).parts([lens(seen)])
    share = sum(part.share for part in parts if part.lenses)
    area = (math.tan(math.radians(seen / 2)) / math.tan(math.radians(whole / 2))) ** 2
    # Half a ring is lost or won where the lens' edge cuts through one.
    assert share == pytest.approx(min(1, area), abs=0.5001 / count)


def test_rings_are_where_points_spread_evenly_over_an_image_are():
    points = torch.rand(400_000, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0)) * 2 - 1
    radius = points.norm(dim=-1)
    quantiles = radius[radius <= 1].quantile(torch.tensor([1 / 8, 3 / 8, 5 / 8, 7 / 8], dtype=torch.float64))
    tangents = [math.tan(math.radians(angle)) for angle in Field.rings(90.0, 4).angles_deg]
    assert tangents == pytest.approx(quantiles.tolist(), abs=3e-3)


def test_shares_sum_to_one():
    parts = Field.rings(120.0, 7).parts([lens(80.0), lens(30.0)])
    assert sum(part.share for part in parts) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([],), "angles_deg must be at least one number >= 0 and < 90 degrees"),
        (([90.0],), "angles_deg must be at least one number >= 0 and < 90 degrees"),
        (([1.0], [1.0, 2.0]), "weights must be 1 finite numbers >= 0, not all 0, one for each angle"),
        (([1.0], [0.0]), "weights must be 1 finite numbers >= 0, not all 0, one for each angle"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(arguments, message):
    with pytest.raises(ValueError, match=message):
        Field(*arguments)


@pytest.mark.parametrize(("arguments", "message"), [((180.0, 3), "field_of_view_deg"), ((90.0, 0), "count")])
def test_rings_out_of_their_range_are_refused_by_name(arguments, message):
    with pytest.raises(ValueError, match=f"^{message} must be"):
        Field.rings(*arguments)
