"""Room on the back against shapely: exact where it says so, within its stated error where it is sampled."""

import numpy as np
import pytest
import shapely
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, box
from torch.autograd import gradcheck

from multilens import Back, Layout, Lens, disc, rectangle
from multilens.constraints import ExactRoom, Room, SampledRoom, body_radius, pair_room, quick_room

ROUNDING = 1e-11
"""mm; coordinates are about 100 mm."""

LENSES = [Lens(6.0, (0.5, 2.0), clearance=5.8), Lens(6.0, (0.5, 2.0)), Lens(6.0, (0.5, 2.0), clearance=0.1)]
LAYOUT = Layout([[0.0, 0.0], [30.0, 40.0], [30.0, 0.0]], [1.927, 1.0, 2.0], [500.0] * 3)


def places(seed: int, reach: float, count: int = 200) -> torch.Tensor:
    return torch.from_numpy(np.random.default_rng(seed).uniform(-reach, reach, (count, 2)))


def room_by_shapely(back: Back, point: torch.Tensor) -> torch.Tensor:
    """Distances to shapely's own geometries, the outline sharp and each keep-out's core grown afterwards."""
    at = shapely.points(point.numpy())
    outline = back.outline.core
    within = np.where(shapely.contains(outline, at), 1, -1) * shapely.distance(outline.boundary, at)
    limits = [within]
    for keep_out in back.keep_outs:
        core = keep_out.shape.core
        distance = np.where(shapely.contains(core, at), -1, 1) * shapely.distance(
            core.boundary if core.area else core, at
        )
        limits.append(distance - keep_out.shape.radius - keep_out.clearance)
    return torch.from_numpy(np.stack(limits, axis=-1))


def furnished(region) -> Back:
    back = Back(region).keep_out("flash", disc((5.0, -3.0), 2.5), clearance=0.3)
    return back.keep_out("logo", rectangle(12, 4, centre=(-10.0, 12.0), corner=1.0), clearance=1.0)


def test_bodies_keep_all_digits_of_their_clearance():
    # 5.8 and 0.1 have no exact binary form: in single precision they would be off by 1e-7.
    torch.testing.assert_close(
        body_radius(LAYOUT, LENSES), torch.tensor([7.727, 1.0, 2.1], dtype=torch.float64), rtol=1e-15, atol=0
    )


def test_room_between_bodies_is_what_their_radii_and_the_gap_leave():
    torch.testing.assert_close(
        pair_room(LAYOUT, LENSES, gap=0.25),
        torch.tensor([50 - 8.727 - 0.25, 30 - 9.827 - 0.25, 40 - 3.1 - 0.25], dtype=torch.float64),
        rtol=1e-14,
        atol=0,
    )


def test_gradient_of_the_room_between_bodies():
    unknowns = [x.clone().requires_grad_() for x in (LAYOUT.position, LAYOUT.aperture_radius)]
    assert gradcheck(lambda p, r: pair_room(Layout(p, r, LAYOUT.focus), LENSES, 0.25), unknowns)


@given(st.integers(0, 2**31))
def test_exact_room_agrees_with_shapely(random_region, seed):
    back, point = furnished(random_region(seed)), places(seed, 90)
    torch.testing.assert_close(ExactRoom(back)(point), room_by_shapely(back, point), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("corner", [0.0, 4.0, 10.0])
def test_exact_room_in_a_rounded_rectangle_is_the_largest_disc_that_fits(corner):
    # Brute force: the least distance to many points of the rim.
    back = Back.rounded_rectangle(30, 20, corner)
    rim = shapely.get_coordinates(back.outline.polygon(2000).segmentize(0.01))
    point = places(0, 8, 50) + torch.tensor([15.0, 10.0], dtype=torch.float64)
    inside = point[torch.from_numpy(shapely.contains_xy(back.outline.polygon(2000), *point.numpy().T))]
    brute = torch.cdist(inside, torch.from_numpy(rim)).amin(-1)
    # Off a straight rim by a point spacing h at most h^2 / (8 d); off an arc of 2,000 edges less than 1e-6 of its radius.
    torch.testing.assert_close(ExactRoom(back)(inside)[:, 0], brute, rtol=0, atol=2e-3)


@given(st.integers(0, 2**31), st.sampled_from([16, 64]))
def test_sampled_room_is_within_half_a_diagonal_of_a_cell(random_region, seed, cells):
    back = furnished(random_region(seed))
    left, top, right, bottom = back.outline.bounds
    share = places(seed, 0.5) + 0.5
    point = torch.tensor([left, top]).double() + share * torch.tensor([right - left, bottom - top], dtype=torch.float64)
    exact = room_by_shapely(back, point).amin(-1, keepdim=True)
    half_diagonal = max(right - left, bottom - top) / cells / 2**0.5
    assert (SampledRoom(back, cells)(point) - exact).abs().max() <= half_diagonal + ROUNDING


@pytest.mark.parametrize(("width", "height"), [(1000.0, 1.0), (1.0, 1000.0), (100.0, 70.3)])
def test_sampled_room_keeps_its_error_on_backs_of_any_shape(width, height):
    back = Back.rectangle(width, height)
    point = (places(0, 0.5) + 0.5) * torch.tensor([width, height], dtype=torch.float64)
    exact = torch.cat([point, torch.tensor([width, height], dtype=torch.float64) - point], dim=-1).amin(
        -1, keepdim=True
    )
    half_diagonal = max(width, height) / 64 / 2**0.5
    assert (SampledRoom(back, 64)(point) - exact).abs().max() <= half_diagonal


def test_sampled_room_is_exact_at_its_nodes():
    back = Back.rectangle(64, 32).keep_out("flash", disc((10.0, 10.0), 3.0))
    x, y = np.meshgrid(np.arange(65.0), np.arange(33.0))
    node = torch.from_numpy(np.stack([x, y], axis=-1))
    exact = ExactRoom(back)(node).amin(-1, keepdim=True)
    torch.testing.assert_close(SampledRoom(back, 64)(node), exact, rtol=0, atol=ROUNDING)


def test_gradient_of_the_sampled_room_agrees_with_finite_differences():
    room = SampledRoom(Back.rectangle(64, 32).keep_out("flash", disc((10.0, 10.0), 3.0)), 64)
    point = (places(1, 0.4, 20) * 30 + 16.0).requires_grad_()
    assert gradcheck(room, point)


@pytest.mark.parametrize("room", [ExactRoom, SampledRoom])
def test_rooms_keep_batches_and_types(room):
    found = room(Back.rectangle(64, 32))(torch.rand(3, 4, 2) * 30)
    assert found.shape == (3, 4, 1)
    assert found.dtype == torch.float32
    assert isinstance(room(Back.rectangle(64, 32)), Room)


def test_few_edges_are_kept_exact_and_many_are_sampled():
    assert isinstance(quick_room(Back.rectangle(10, 10)), ExactRoom)
    assert isinstance(quick_room(Back(Point(0, 0).buffer(10, quad_segs=30))), SampledRoom)


def test_edges_of_keep_outs_count_too():
    assert isinstance(quick_room(Back(box(0, 0, 50, 50)).keep_out("logo", Point(9, 9).buffer(2))), SampledRoom)
