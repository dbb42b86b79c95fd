"""Torch's distances against shapely's, on random regions and on the shapes that have a closed form."""

from math import cos, pi, sin

import numpy as np
import pytest
import shapely
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, box
from torch.autograd import grad, gradcheck

from multilens.geometry.distance import is_inside, offset_from_segments, signed_distance
from multilens.geometry.shape import Shape, disc, rectangle

ROUNDING = 1e-11
"""mm; coordinates are about 100 mm, and a distance takes a few tens of roundings."""

seeds = st.integers(0, 2**31)


def places(seed: int, count: int = 200, reach: float = 90.0) -> torch.Tensor:
    return (torch.rand(count, 2, generator=torch.Generator().manual_seed(seed), dtype=torch.float64) - 0.5) * 2 * reach


def to_shape(shape: Shape, point: torch.Tensor) -> torch.Tensor:
    return signed_distance(point, torch.from_numpy(shape.segments), shape.radius)


@given(seeds)
def test_distance_to_a_region_agrees_with_shapely(random_region, seed):
    region, point = random_region(seed), places(seed)
    at = shapely.points(point.numpy())
    sign = np.where(shapely.contains(region, at), -1, 1)
    expected = torch.from_numpy(sign * shapely.distance(region.boundary, at))
    torch.testing.assert_close(to_shape(Shape(region), point), expected, rtol=0, atol=ROUNDING)


@given(seeds)
def test_inside_agrees_with_shapely(random_region, seed):
    region, point = random_region(seed), places(seed)
    expected = torch.from_numpy(shapely.contains_xy(region, *point.numpy().T))
    assert is_inside(point, torch.from_numpy(Shape(region).segments)).equal(expected)


@given(seeds)
def test_gradient_has_length_one(random_region, seed):
    point = places(seed).requires_grad_()
    (slope,) = grad(to_shape(Shape(random_region(seed)), point).sum(), point)
    torch.testing.assert_close(slope.norm(dim=-1), torch.ones(len(point)).double(), rtol=0, atol=1e-9)


@given(seeds)
def test_a_step_along_the_gradient_leads_to_the_rim(random_region, seed):
    shape, point = Shape(random_region(seed)), places(seed).requires_grad_()
    distance = to_shape(shape, point)
    (slope,) = grad(distance.sum(), point)
    rim = (point - distance.unsqueeze(-1) * slope).detach().numpy()
    assert shapely.distance(shape.core.boundary, shapely.points(rim)).max() < ROUNDING


def test_distance_to_a_disc_is_that_to_its_centre_less_the_radius():
    point, centre = places(1), torch.tensor([3.0, -4.0]).double()
    expected = (point - centre).norm(dim=-1) - 12.5
    torch.testing.assert_close(to_shape(disc((3.0, -4.0), 12.5), point), expected, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("corner", [0.0, 5.0, 14.9, 15.0])
def test_distance_to_a_rounded_rectangle_is_the_closed_form(corner):
    point, centre, half = places(2), torch.tensor([10.0, -5.0]).double(), torch.tensor([30.0, 15.0]).double()
    # By symmetry in one quarter: the distance beyond the corner's centre, or to the nearer side.
    beyond = (point - centre).abs() - half + corner
    expected = beyond.clamp(min=0).norm(dim=-1) + beyond.amax(-1).clamp(max=0) - corner
    shape = rectangle(60, 30, centre=(10.0, -5.0), corner=corner)
    torch.testing.assert_close(to_shape(shape, point), expected, rtol=0, atol=ROUNDING)


def test_distance_to_a_bent_capsule_is_that_to_its_line_less_the_radius():
    line, point = LineString([(-40, 0), (0, 30), (40, -10)]), places(3)
    expected = torch.from_numpy(shapely.distance(line, shapely.points(point.numpy()))) - 7.5
    torch.testing.assert_close(to_shape(Shape(line, 7.5), point), expected, rtol=0, atol=ROUNDING)


def test_distance_does_not_change_when_all_is_turned():
    turn = torch.tensor([[cos(1.0), sin(1.0)], [-sin(1.0), cos(1.0)]], dtype=torch.float64)
    point, segments = places(4), torch.from_numpy(rectangle(60, 30).segments)
    turned = signed_distance(point @ turn, segments @ turn)
    torch.testing.assert_close(turned, signed_distance(point, segments), rtol=0, atol=ROUNDING)


def test_gradient_agrees_with_finite_differences():
    point = torch.tensor([[7.0, 9.0], [-20.0, 3.0], [70.0, 40.0], [31.0, 2.0]]).double().requires_grad_()
    shape = rectangle(60, 30, corner=5)
    assert gradcheck(lambda p: to_shape(shape, p), point)


@pytest.mark.parametrize(
    ("shape", "at"),
    [(disc((1.0, 2.0), 3.0), (1.0, 2.0)), (Shape(LineString([(0, 0), (9, 3)]), 1.0), (3.0, 1.0))],
    ids=["centre of a disc", "axis of a capsule"],
)
def test_gradient_is_zero_where_there_is_none(shape, at):
    point = torch.tensor([at], dtype=torch.float64, requires_grad=True)
    to_shape(shape, point).sum().backward()
    assert point.grad is not None
    assert point.grad.tolist() == [[0.0, 0.0]]


FRAME = Shape(box(0, 0, 20, 10).difference(box(5, 2, 15, 8)).union(box(30, 0, 40, 10)))


@pytest.mark.parametrize(
    ("shape", "at", "outward"),
    [
        (FRAME, (0.0, 5.0), (-1, 0)),
        (FRAME, (7.0, 10.0), (0, 1)),
        (FRAME, (5.0, 4.0), (1, 0)),
        (FRAME, (15.0, 4.0), (-1, 0)),
        (FRAME, (40.0, 5.0), (1, 0)),
        (rectangle(20, 20, corner=5), (15.0, 9.0), (1, 0)),
    ],
    ids=["left", "top", "left of the hole", "right of the hole", "another part", "core of a round shape"],
)
def test_gradient_on_an_edge_is_the_normal_that_points_out(shape, at, outward):
    point = torch.tensor([at], dtype=torch.float64, requires_grad=True)
    distance = to_shape(shape, point)
    (slope,) = grad(distance.sum(), point)
    assert distance.item() == -shape.radius
    assert slope.tolist() == [list(outward)]


@pytest.mark.parametrize("axis", [0, 1])
def test_gradient_on_an_edge_agrees_with_finite_differences(axis):
    at = torch.tensor([[0.0, 5.0], [7.0, 10.0], [5.0, 4.0]], dtype=torch.float64, requires_grad=True)
    (slope,) = grad(to_shape(FRAME, at).sum(), at)
    step = torch.zeros(2, dtype=torch.float64)
    step[axis] = 1e-6
    rise = (to_shape(FRAME, at + step) - to_shape(FRAME, at - step)) / 2e-6
    torch.testing.assert_close(slope[:, axis], rise.detach(), rtol=0, atol=1e-6)


def test_between_two_sides_the_gradient_is_a_mean_of_theirs():
    point = torch.tensor([[15.0, 15.0]], dtype=torch.float64, requires_grad=True)
    to_shape(rectangle(100, 30), point).sum().backward()
    assert point.grad is not None
    # Nearest to the left, the top and the bottom side alike: (-1, 0), (0, -1) and (0, 1), any mean of which is a subgradient.
    assert point.grad.tolist() == [[pytest.approx(-1 / 3), 0.0]]


def test_batches_and_types_are_kept():
    segments = torch.from_numpy(rectangle(60, 30).segments).float()
    distance = signed_distance(torch.rand(2, 3, 4, 2), segments)
    assert distance.shape == (2, 3, 4)
    assert distance.dtype == torch.float32


def test_offset_from_a_segment_of_no_length_is_that_from_its_point():
    point = torch.tensor([[3.0, 4.0]])
    assert offset_from_segments(point, torch.zeros(1, 2, 2)).tolist() == [[[3.0, 4.0]]]


@pytest.mark.parametrize("angle", [0.0, 0.5, pi / 2, 3.0])
def test_single_precision_tells_sides_apart_to_a_micrometre(angle):
    # The wide search runs in single precision: a millionth of 60 mm is well below what the penalty looks at.
    rim = torch.tensor([[30 + 30 * cos(angle), 15 + 30 * sin(angle)]]).double()
    segments = torch.from_numpy(disc((30.0, 15.0), 30.0).segments)
    assert signed_distance(rim.float(), segments.float(), 30.0).abs().item() < 1e-5
