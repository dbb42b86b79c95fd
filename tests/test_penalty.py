"""Both penalties against an independent referee: nothing to pay where shapely finds a layout feasible, something where not."""

import pytest
import torch
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import Point, box
from torch.autograd import grad, gradcheck

from multilens import Back, Layout, Lens, Problem, area_penalty, disc, distance_penalty
from multilens.geometry.overlap import EDGES

BACK = Back.rectangle(60, 40).keep_out("flash", disc((30.0, 20.0), 4.0), clearance=1.0)
LENSES = [Lens(6.0, (0.5, 6.0), clearance=1.0), Lens(6.0, (0.5, 6.0)), Lens(6.0, (1.0, 6.0))]
GAP = 0.5
PROBLEM = Problem(BACK, LENSES, [300.0, 900.0], gap=GAP)
PENALTIES = pytest.mark.parametrize("penalty", [distance_penalty, area_penalty])

FUZZ = 10 * (2 / EDGES) ** 2
"""mm; the area penalty takes a disc for a polygon of its area, whose rim lies within 2.1e-4 of the radius, at most 7.5 mm,
of the disc's, and so has a price up to that far from touching."""


def layout(places: list[tuple[float, float]], radii: list[float]) -> Layout:
    return Layout([list(place) for place in places], radii, [500.0] * len(places))


def rooms(places: list[tuple[float, float]], radii: list[float]) -> list[float]:
    """Every distance beyond what is required, by shapely's points and boxes."""
    points = [Point(place) for place in places]
    body = [radius + lens.clearance for radius, lens in zip(radii, LENSES, strict=True)]
    outline = box(0, 0, 60, 40)
    within = [
        (1 if outline.contains(p) else -1) * outline.boundary.distance(p) - r for p, r in zip(points, body, strict=True)
    ]
    clear = [Point(30, 20).distance(p) - 5 - r for p, r in zip(points, body, strict=True)]
    apart = [points[i].distance(points[j]) - body[i] - body[j] - GAP for i in range(3) for j in range(i)]
    return within + clear + apart


some_places = st.lists(st.tuples(st.floats(-5, 65), st.floats(-5, 45)), min_size=3, max_size=3)
some_radii = st.lists(st.floats(0.5, 6), min_size=3, max_size=3)


@PENALTIES
@given(places=some_places, radii=some_radii)
def test_a_layout_costs_something_if_and_only_if_it_lacks_room(penalty, places, radii):
    room = min(rooms(places, radii))
    assume(abs(room) > FUZZ)
    price = penalty(PROBLEM)(layout(places, radii)).item()
    assert (price > 0) == (room < 0)


@PENALTIES
@given(
    shift=st.tuples(st.floats(-4, 4), st.floats(-4, 4)),
    radii=st.lists(st.floats(0.5, 1.9), min_size=3, max_size=3),
)
def test_a_layout_with_room_everywhere_costs_nothing(penalty, shift, radii):
    places = [(10 + shift[0], 10 + shift[1]), (50 - shift[0], 8 + shift[1]), (12 + shift[0], 32 - shift[1])]
    assume(min(rooms(places, radii)) > FUZZ)
    assert penalty(PROBLEM)(layout(places, radii)).item() == 0


FAR = [(10.0, 8.0), (50.0, 8.0), (10.0, 32.0)]


@PENALTIES
@pytest.mark.parametrize(
    ("places", "radii"),
    [
        ([(1.9, 8.0), FAR[1], FAR[2]], [1.0, 1.0, 1.0]),
        ([FAR[0], (27.0, 14.2), FAR[2]], [1.0, 1.8, 1.0]),
        ([FAR[0], (13.4, 8.0), FAR[2]], [1.0, 1.0, 1.0]),
        ([FAR[0], FAR[1], (-9.0, 20.0)], [1.0, 1.0, 1.0]),
        ([FAR[0], FAR[1], (29.0, 20.0)], [1.0, 1.0, 1.0]),
    ],
    ids=["over the rim", "near the flash", "within the gap", "far off", "on the flash"],
)
def test_each_kind_of_missing_room_has_its_price(penalty, places, radii):
    assert penalty(PROBLEM)(layout(places, radii)).item() > 0


@PENALTIES
def test_a_layout_pays_the_same_alone_and_in_a_batch(penalty):
    random = torch.Generator().manual_seed(0)
    batch = Layout(
        torch.rand(5, 3, 2, generator=random).double() * 50, torch.full((5, 3), 3.0).double(), torch.ones(5, 3).double()
    )
    price = penalty(PROBLEM)
    alone = torch.stack([price(batch[index]) for index in range(5)])
    torch.testing.assert_close(price(batch), alone, rtol=1e-12, atol=0)


def test_distance_price_grows_with_the_square_of_what_is_missing():
    # Lens 2, of radius 1, stands 0.8 and 0.4 mm from the left side: 0.2 and three times that are missing.
    price = distance_penalty(PROBLEM)
    once, thrice = (price(layout([FAR[0], (place, 20.0), FAR[1]], [1.0, 1.0, 1.0])) for place in (0.8, 0.4))
    assert (thrice / once).item() == pytest.approx(9)


def test_area_price_grows_with_the_area_outside():
    # Half of lens 2 is outside, and then the same half of one of twice the radius.
    price = area_penalty(PROBLEM)
    once, again = (price(layout([FAR[0], (0.0, 20.0), FAR[1]], [1.0, radius, 1.0])) for radius in (1.0, 2.0))
    assert (again / once).item() == pytest.approx(4)


@PENALTIES
def test_gradient_agrees_with_finite_differences(penalty):
    price = penalty(PROBLEM)
    places = torch.tensor([[1.3, 8.2], [4.1, 11.6], [26.2, 23.1]], dtype=torch.float64, requires_grad=True)
    radii = torch.tensor([2.1, 3.3, 2.7], dtype=torch.float64, requires_grad=True)
    focus = torch.ones(3, 1, dtype=torch.float64)
    assert gradcheck(lambda p, r: price(Layout(p, r, focus)), (places, radii))


@PENALTIES
def test_gradient_parts_two_lenses_that_overlap(penalty):
    places = torch.tensor([[12.0, 20.0], [15.0, 20.0], [50.0, 20.0]], dtype=torch.float64, requires_grad=True)
    price = penalty(PROBLEM)(Layout(places, torch.full((3,), 2.0).double(), torch.ones(3, 1).double()))
    (slope,) = grad(price, places)
    assert slope[0, 0] > 0 > slope[1, 0]


@PENALTIES
@pytest.mark.parametrize("place", [(0.0, 20.0), (60.0, 20.0), (20.0, 0.0), (20.0, 40.0), (0.0, 0.0)])
def test_a_lens_on_the_rim_is_led_inside(penalty, place):
    # The search holds lenses to the bounding box: its sides are where they come to stand.
    places = torch.tensor([FAR[0], place, FAR[1]], dtype=torch.float64, requires_grad=True)
    price = penalty(PROBLEM)(Layout(places, torch.full((3,), 2.0).double(), torch.ones(3, 1).double()))
    (slope,) = grad(price, places)
    inward = torch.tensor([30.0, 20.0]).double() - places[1].detach()
    assert (-slope[1] * inward).sum() > 0


@PENALTIES
def test_gradient_is_finite_at_coincident_centres(penalty):
    places = torch.full((3, 2), 20.0, dtype=torch.float64, requires_grad=True)
    price = penalty(PROBLEM)(Layout(places, torch.full((3,), 2.0).double(), torch.ones(3, 1).double()))
    (slope,) = grad(price, places)
    assert slope.isfinite().all()


@PENALTIES
def test_one_lens_pays_for_the_back_alone(penalty):
    problem = Problem(BACK, LENSES[:1], [300.0])
    assert penalty(problem)(layout([FAR[0]], [1.0])).item() == 0
    assert penalty(problem)(layout([(0.0, 0.0)], [1.0])).item() > 0


@PENALTIES
def test_single_precision_stays_single(penalty):
    price = penalty(PROBLEM)(layout(FAR, [1.0] * 3).to(torch.float32))
    assert price.dtype == torch.float32


def test_a_sampled_back_costs_nothing_well_inside_and_something_well_outside():
    # More edges than are kept exact: within half a cell of touching the price is not certain, beyond it is.
    round_back = Problem(Back(Point(0, 0).buffer(30, quad_segs=30)), LENSES, [300.0])
    half_diagonal = 60 / 384 / 2**0.5
    price = distance_penalty(round_back)
    for beyond in (-1.1, 1.1):
        reach = 30 * 0.9997 - 1 + beyond * half_diagonal
        cost = price(layout([(reach, 0.0), (-10.0, 0.0), (0.0, 10.0)], [0.5, 1.0, 1.0]))
        first_alone = price(layout([(0.0, -15.0), (reach, 0.0), (0.0, 10.0)], [0.5, 1.0, 1.0]))
        assert (first_alone.item() > 0) == (beyond > 0)
        assert cost.item() > 0
