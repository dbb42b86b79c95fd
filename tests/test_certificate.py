"""The certificate against shapely where there is room, and against exact decimals where there is none."""

from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import MultiPolygon, Point, box

from multilens import Back, Layout, Lens, disc
from multilens.certificate import Certificate, certify

MARGIN = 1e-3
"""mm; shapely's discs of 256 edges a quarter are within 1e-5 of their radius, some 20 mm, of a circle."""

FREE = Lens(6.0, (1e-3, 1e3))
ATOM = 1e-15
"""mm; less than a float of the size of a back can hold, but not less than a decimal can."""


def check(
    back: Back,
    places: list[tuple[float, float]],
    radii: list[float],
    lenses: list[Lens] | None = None,
    gap: float = 0.0,
    focus: list[list[float]] | None = None,
) -> Certificate:
    lenses = lenses or [FREE] * len(places)
    layout = Layout([list(place) for place in places], radii, focus or [[500.0]] * len(places))
    return certify(back, lenses, [(200.0, 5000.0)] * len(places), layout, gap)


def broken(certificate: Certificate) -> list[str]:
    return [clearance.what for clearance in certificate.clearances if not clearance.kept]


# Touching


def test_two_discs_that_touch_each_other_and_the_sides_are_feasible():
    assert check(Back.rectangle(10, 10), [(2.5, 2.5), (7.5, 2.5)], [2.5, 2.5]).feasible


@pytest.mark.parametrize(
    ("places", "radii", "what"),
    [
        ([(2.5, 2.5), (7.5, 2.5)], [2.5, 2.500000000000001], ["lens 2 within outline", "lens 1 to lens 2"]),
        ([(2.499999999999999, 5.0), (7.5, 5.0)], [2.5, 2.5], ["lens 1 within outline"]),
        ([(2.5, 5.0), (7.499999999999999, 5.0)], [2.5, 2.5], ["lens 1 to lens 2"]),
        ([(2.5, 5.0), (7.500000000000001, 5.0)], [2.5, 2.5], ["lens 2 within outline"]),
    ],
    ids=["too wide", "too far left", "too close", "too far right"],
)
def test_a_millionth_of_a_nanometre_too_little_is_not(places, radii, what):
    assert broken(check(Back.rectangle(10, 10), places, radii)) == what


def test_decimals_that_binary_cannot_hold_are_meant_as_written():
    # In floats 0.3 - 0.2 < 0.1 and 0.1 + 0.2 > 0.3; the decimals touch.
    assert check(Back.rectangle(0.6, 0.2), [(0.1, 0.1), (0.3, 0.1), (0.5, 0.1)], [0.1] * 3).feasible


def test_a_pythagorean_pair_touches():
    assert check(Back.rectangle(20, 20), [(5.0, 5.0), (8.3, 9.4)], [2.75, 2.75]).feasible
    assert not check(Back.rectangle(20, 20), [(5.0, 5.0), (8.3, 9.4)], [2.75, 2.75 + 4 * ATOM]).feasible


def test_a_disc_may_fill_a_disc():
    assert check(Back.disc(10), [(0.0, 0.0)], [10.0]).feasible
    assert not check(Back.disc(10), [(0.0, ATOM)], [10.0]).feasible


def test_a_disc_touches_a_round_back_from_inside():
    # 3-4-5: the centre 5 mm from the middle of a disc of 10 mm.
    assert check(Back.disc(10), [(3.0, -4.0)], [5.0]).feasible
    assert not check(Back.disc(10), [(3.0, -4.000000000000001)], [5.0]).feasible


def test_a_disc_touches_a_round_corner_from_inside():
    # The corner is centred on (5, 5) with radius 5; 3-4-5 again, at half the size.
    back = Back.rounded_rectangle(30, 20, corner=5)
    assert check(back, [(3.5, 3.0)], [2.5]).feasible
    assert not check(back, [(3.5, 2.999999999999999)], [2.5]).feasible


def test_a_disc_as_large_as_the_corner_may_stand_in_it():
    back = Back.rounded_rectangle(30, 20, corner=5)
    assert check(back, [(5.0, 5.0)], [5.0]).feasible
    assert not check(back, [(5.0, 4.999999999999999)], [5.0]).feasible


def test_a_disc_touches_the_side_of_a_rounded_rectangle():
    back = Back.rounded_rectangle(76.73, 159.86, corner=13)
    assert check(back, [(70.23, 80.0)], [6.5]).feasible
    assert not check(back, [(70.23000000000002, 80.0)], [6.5]).feasible


def test_a_disc_touches_the_end_of_a_stadium():
    back = Back.rounded_rectangle(30, 10, corner=5)
    assert check(back, [(3.5, 3.0)], [2.5]).feasible
    assert not check(back, [(3.5, 2.999999999999999)], [2.5]).feasible


def test_keep_outs_are_kept_clear_of_by_their_own_clearance():
    back = Back.rectangle(40, 40).keep_out("flash", disc((10.0, 10.0), 2.0), clearance=0.5)
    # 3-4-5 three times over: 15 mm from the flash, of which 2.5 are its own.
    assert check(back, [(19.0, 22.0)], [12.5]).feasible
    assert broken(check(back, [(18.999999999999996, 22.0)], [12.5])) == ["lens 1 to flash"]


def test_clearance_of_the_body_counts_everywhere():
    lens = Lens(6.0, (1.0, 3.0), clearance=1.5)
    back = Back.rectangle(10, 5).keep_out("flash", box(5, 0, 10, 5))
    assert check(back, [(2.5, 2.5)], [1.0], [lens]).feasible
    assert broken(check(back, [(2.5, 2.5)], [1.000000000000001], [lens])) == [
        "lens 1 within outline",
        "lens 1 to flash",
    ]


def test_gap_is_kept_between_bodies():
    assert check(Back.rectangle(20, 20), [(5.0, 5.0), (11.2, 5.0)], [3.0, 3.0], gap=0.2).feasible
    assert broken(check(Back.rectangle(20, 20), [(5.0, 5.0), (11.2, 5.0)], [3.0, 3.0], gap=0.2000000000000001)) == [
        "lens 1 to lens 2"
    ]


# On the wrong side


@pytest.mark.parametrize(
    ("back", "place"),
    [
        (Back.rectangle(10, 10), (50.0, 5.0)),
        (Back.rectangle(10, 10), (10.0, 5.0)),
        (Back(box(0, 0, 10, 10).difference(box(4, 4, 6, 6))), (5.0, 5.0)),
        (Back(MultiPolygon([box(0, 0, 4, 4), box(6, 0, 9, 4)])), (5.0, 2.0)),
        (Back.rectangle(10, 10).keep_out("logo", box(2, 2, 8, 8)), (5.0, 5.0)),
        (Back.rectangle(10, 10).keep_out("logo", disc((5.0, 5.0), 3.0)), (5.0, 5.0)),
    ],
    ids=["far off", "on the rim", "in a hole", "between two parts", "in a keep-out", "at the centre of a keep-out"],
)
def test_a_lens_in_the_wrong_place_is_not_feasible(back, place):
    certificate = check(back, [place], [0.01])
    assert not certificate.feasible
    assert certificate.tightest.room < 0


# Bounds and locks


@pytest.mark.parametrize(
    ("radius", "feasible"), [(1.927, True), (1.9270000000000003, False), (0.5, True), (0.49999999999999994, False)]
)
def test_apertures_are_held_to_their_bounds(radius, feasible):
    certificate = check(Back.rectangle(10, 10), [(5.0, 5.0)], [radius], [Lens(6.0, (0.5, 1.927))])
    assert broken(certificate) == ([] if feasible else ["aperture of lens 1"])


@pytest.mark.parametrize(("focus", "feasible"), [([200.0, 5000.0], True), ([199.99999999999997, 300.0], False)])
def test_every_focus_is_held_to_its_bounds(focus, feasible):
    lens = Lens(6.0, (0.5, 2.0), tiers=2)
    certificate = check(Back.rectangle(10, 10), [(5.0, 5.0)], [1.0], [lens], focus=[focus])
    assert broken(certificate) == ([] if feasible else ["focus of lens 1"])


@pytest.mark.parametrize(
    ("lock", "place", "feasible"),
    [
        ((4.1, 5.3), (4.1, 5.3), True),
        ((4.1, 5.3), (4.1, 5.300000000000001), False),
        ((None, 5.3), (7.0, 5.3), True),
        ((None, 5.3), (7.0, 5.299999999999999), False),
    ],
)
def test_a_locked_lens_stands_in_its_place(lock, place, feasible):
    certificate = check(Back.rectangle(10, 10), [place], [1.0], [Lens(6.0, (0.5, 2.0), position=lock)])
    assert broken(certificate) == ([] if feasible else ["lens 1 in its place"])


# What it says


def test_room_is_what_is_left():
    back = Back.rectangle(20, 10).keep_out("flash", disc((18.0, 5.0), 1.0), clearance=0.5)
    certificate = check(back, [(3.0, 5.0), (10.0, 5.0)], [2.0, 2.5], gap=0.5)
    room = {clearance.what: clearance.room for clearance in certificate.clearances}
    assert room["lens 1 within outline"] == 1.0
    assert room["lens 2 within outline"] == 2.5
    assert room["lens 1 to lens 2"] == 2.0
    assert room["lens 2 to flash"] == 4.0


def test_tightest_is_a_broken_constraint_before_any_other():
    certificate = check(Back.rectangle(20, 10), [(5.0, 5.0), (10.0, 5.0)], [3.0, 2.0])
    assert certificate.tightest.what == "lens 1 to lens 2"
    certificate = check(Back.rectangle(20, 10), [(5.0, 5.0), (10.0, 5.0)], [3.0, 2.5])
    assert certificate.tightest.room == pytest.approx(-0.5)


def test_closest_is_a_distance_between_things_and_no_bound():
    certificate = check(Back.rectangle(20, 10), [(5.0, 5.0), (10.0, 5.0)], [2.0, 2.0])
    assert (certificate.closest.what, certificate.closest.room) == ("lens 1 to lens 2", 1.0)


# Shapely as the referee


@given(st.integers(0, 2**31))
def test_feasible_layouts_are_those_shapely_finds_feasible(random_region, seed):
    region, random = random_region(seed), np.random.default_rng(seed)
    back = Back(region).keep_out("flash", disc((0.0, 0.0), 4.0), clearance=1.0)
    places = [tuple(place) for place in random.uniform(-40, 40, (3, 2))]
    radii = random.uniform(0.1, 4, 3).tolist()
    certificate = check(back, places, radii)
    discs = [Point(place).buffer(radius, quad_segs=256) for place, radius in zip(places, radii, strict=True)]
    rooms = [
        *(
            region.boundary.distance(Point(p)) * (1 if region.contains(Point(p)) else -1) - r
            for p, r in zip(places, radii, strict=True)
        ),
        *(Point(0, 0).distance(Point(p)) - 5 - r for p, r in zip(places, radii, strict=True)),
        *(Point(places[i]).distance(Point(places[j])) - radii[i] - radii[j] for i in range(3) for j in range(i)),
    ]
    assume(min(abs(room) for room in rooms) > MARGIN)
    keep_out = Point(0, 0).buffer(5.0, quad_segs=256)
    expected = (
        all(region.contains(one) for one in discs)
        and not any(keep_out.intersects(one) for one in discs)
        and not any(discs[i].intersects(discs[j]) for i in range(3) for j in range(i))
    )
    assert certificate.feasible == expected


@given(st.integers(0, 2**31), st.floats(0.5, 12))
def test_room_within_a_region_agrees_with_shapely(random_region, seed, radius):
    region = random_region(seed)
    place = region.representative_point()
    certificate = check(Back(region), [(place.x, place.y)], [radius])
    (within,) = [c for c in certificate.clearances if "outline" in c.what]
    assert within.room == pytest.approx(region.boundary.distance(place) - radius, abs=1e-11)


@given(st.floats(0, 2 * pi), st.floats(0.5, 9.0), st.floats(-1.0, 1.0))
def test_room_in_a_round_corner_agrees_with_the_closed_form(angle, radius, beyond):
    # Around the centre of the corner at (10, 10), in the quarter that it rounds.
    angle = pi + angle / 4
    reach = 10 - radius + beyond * 0.5
    assume(reach > 0 and abs(beyond) > 1e-6)
    place = (10 + reach * cos(angle), 10 + reach * sin(angle))
    certificate = check(Back.rounded_rectangle(60, 40, corner=10), [place], [radius])
    (within,) = [c for c in certificate.clearances if "outline" in c.what]
    assert within.room == pytest.approx(-beyond * 0.5, abs=1e-12)
    assert within.kept == (beyond < 0)


def test_square_root_of_two_is_decided_exactly():
    # Bodies on a diagonal: sqrt(2) * 5 is 7.0710678118654752440..., between these two sums of radii.
    places = [(5.0, 5.0), (10.0, 10.0)]
    assert check(Back.rectangle(30, 30), places, [4.0, 3.071067811865475]).feasible
    assert not check(Back.rectangle(30, 30), places, [4.0, 3.071067811865476]).feasible
    assert sqrt(50) - 4.0 not in (3.071067811865475, 3.071067811865476)
