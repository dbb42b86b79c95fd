from collections.abc import Callable
from math import hypot

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import approx_fprime
from shapely import Point, Polygon

import multilens as ml
from multilens.constraints import ExactRoom, body_radius, pair_room
from multilens.search.limits import Limits
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables


def asked(back: ml.Back, lenses: int = 1) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, [ml.Lens(1.0, (0.5, 1.0))] * lenses, score=lambda layout: -layout.aperture_radius)


def at(*places: tuple[float, float]) -> ml.Layout:
    return ml.Layout([list(place) for place in places], [0.5] * len(places), [1.0] * len(places))


def starts_of(problem: ml.Problem, count: int, seed: int) -> ml.Layout:
    variables = Variables(problem)
    return variables.layout(scattered_starts(problem, variables, count, seed))


def test_ways_are_the_gradients_of_the_room(crowded: ml.Problem) -> None:
    limits = Limits(crowded)
    for layout in (starts_of(crowded, 6, seed=2)[index] for index in range(6)):

        def rooms(position: np.ndarray, layout: ml.Layout = layout) -> np.ndarray:
            room = limits(ml.Layout(torch.from_numpy(position).view(3, 2), layout.aperture_radius, layout.focus))
            return np.append(room.apart, room.inside.flatten())

        room = limits(layout)
        expected = torch.zeros(3 + room.inside.numel(), 3, 2, dtype=torch.float64)
        for pair, (first, second) in enumerate(((0, 1), (0, 2), (1, 2))):
            expected[pair, first], expected[pair, second] = room.parting[pair], -room.parting[pair]
        for lens in range(3):
            expected[3:].view(3, -1, 3, 2)[lens, :, lens] = room.inward[lens]
        counts = torch.from_numpy(rooms(layout.position.flatten().numpy())) < limits.no_limit / 2
        # A step across the edge of a shape would not be a derivative: no start stands that close to one.
        found = torch.from_numpy(approx_fprime(layout.position.flatten().numpy(), rooms, 1e-7)).view(-1, 3, 2)
        torch.testing.assert_close(expected[counts], found[counts], rtol=0, atol=2e-6)


def test_least_room_is_the_least_that_the_constraints_leave(crowded: ml.Problem) -> None:
    layout = starts_of(crowded, 50, seed=4)
    inside = ExactRoom(crowded.back)(layout.position).amin(-1) - body_radius(layout, crowded.lenses)
    least = torch.minimum(inside.amin(-1), pair_room(layout, crowded.lenses, crowded.gap).amin(-1))
    torch.testing.assert_close(Limits(crowded)(layout).least, least, rtol=0, atol=1e-12)


@given(st.integers(0, 2**31))
def test_least_room_at_any_edge_is_the_distance_to_the_rim(random_region: Callable[[int], Polygon], seed: int) -> None:
    region = random_region(seed)
    points = np.random.default_rng(seed).uniform(-80, 80, (20, 2))
    room = Limits(asked(ml.Back(region), 20))(at(*[(x, y) for x, y in points.tolist()])).inside.amin(-1)
    for (x, y), found in zip(points, room.tolist(), strict=True):
        distance = region.boundary.distance(Point(x, y))
        assert found == pytest.approx((distance if region.covers(Point(x, y)) else -distance) - 0.5, abs=1e-9)


@pytest.mark.parametrize(
    ("back", "place", "room"),
    [
        (ml.Back.disc(10.0), (3.0, 4.0), 4.5),
        (ml.Back.disc(10.0), (0.0, 0.0), 9.5),
        (ml.Back.disc(10.0), (9.0, 12.0), -5.5),
        # From the middle of the round corner at (3, 3) to (2, 1) it is sqrt(5).
        (ml.Back.rounded_rectangle(20, 10, 3.0), (2.0, 1.0), 3 - 5**0.5 - 0.5),
        (ml.Back.rounded_rectangle(20, 10, 3.0), (10.0, 4.0), 3.5),
        (ml.Back.rounded_rectangle(20, 10, 5.0), (0.0, 5.0), -0.5),
        (ml.Back.disc(10.0).keep_out("flash", ml.disc((0.0, 0.0), 2.0), 0.25), (3.0, 0.0), 0.25),
        (ml.Back.disc(10.0).keep_out("flash", ml.disc((0.0, 0.0), 2.0), 0.25), (1.0, 0.0), -1.75),
    ],
)
def test_round_rims_by_hand(back: ml.Back, place: tuple[float, float], room: float) -> None:
    assert Limits(asked(back))(at(place)).least.item() == pytest.approx(room, abs=1e-12)


def test_room_of_a_pair_by_hand() -> None:
    lenses = [ml.Lens(1.0, (0.5, 1.0), clearance=0.25), ml.Lens(1.0, (0.5, 2.0), clearance=1.0)]
    problem = ml.ScoreProblem(ml.Back.rectangle(20, 20), lenses, lambda layout: -layout.aperture_radius, gap=0.125)
    room = Limits(problem)(ml.Layout([[4.0, 4.0], [7.0, 8.0]], [0.5, 1.5], [1.0, 1.0]))
    assert room.apart.item() == 5 - 0.75 - 2.5 - 0.125
    torch.testing.assert_close(room.parting, torch.tensor([[-0.6, -0.8]], dtype=torch.float64))


def test_a_corner_limits_by_two_edges() -> None:
    room = Limits(asked(ml.Back.rectangle(10, 6)))(at((9.0, 5.25)))
    assert sorted(room.inside.flatten().tolist())[:2] == pytest.approx([0.25, 0.5])


def test_a_lens_off_the_back_is_sent_to_the_nearest_edge() -> None:
    back = ml.Back.rectangle(10, 10).keep_out("logo", ml.rectangle(4, 4, centre=(5, 5)))
    # 0.3 mm inside the left side of the keep-out: to get clear by 0.5 mm it has to go 0.8 mm to the left.
    room = Limits(asked(back))(at((3.3, 5.0)))
    worst = room.inside.argmin()
    assert room.inside.flatten()[worst].item() == pytest.approx(-0.8, abs=1e-12)
    assert room.inward.view(-1, 2)[worst].tolist() == pytest.approx([-1.0, 0.0])


@pytest.mark.parametrize("back", [ml.Back.rectangle(10, 10), ml.Back(ml.disc((5.0, 5.0), 5.0))], ids=["edge", "disc"])
def test_a_lens_on_the_rim_is_sent_inward(back: ml.Back) -> None:
    room = Limits(asked(back))(at((0.0, 5.0)))
    assert room.inward.view(-1, 2)[room.inside.argmin()].tolist() == pytest.approx([1.0, 0.0])


def test_coincident_lenses_have_no_way_but_finite_numbers() -> None:
    room = Limits(asked(ml.Back.rectangle(10, 10), 2))(at((5.0, 5.0), (5.0, 5.0)))
    assert room.apart.item() == -1.0
    assert room.parting.tolist() == [[0.0, 0.0]]


def test_a_single_lens_has_the_room_of_its_edges() -> None:
    assert Limits(asked(ml.Back.rectangle(10, 6)))(at((2.0, 3.0))).least.item() == 1.5


def test_a_batch_is_as_each_layout_by_itself(crowded: ml.Problem) -> None:
    limits, layouts = Limits(crowded), starts_of(crowded, 6, seed=8)
    together, alone = limits(layouts), limits(layouts[4])
    for name, part in vars(alone).items():
        torch.testing.assert_close(getattr(together, name)[4], part, rtol=0, atol=1e-12)


def test_room_across_a_notch_counts_by_the_way_the_crow_flies() -> None:
    back = ml.Back(ml.polygon([(0, 0), (30, 0), (30, 12), (14, 12), (14, 30), (0, 30)]))
    room = Limits(asked(back))(at((11.0, 8.0)))
    # The corner of the notch at (14, 12) is a 3-4-5 triangle away.
    assert room.least.item() == pytest.approx(hypot(3, 4) - 0.5, abs=1e-12)
