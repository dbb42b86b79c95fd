"""Proofs that nothing fits, against radii known to fit and radii known not to."""

from math import hypot, inf, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.bounds.packing import Space, florian_density, ladder_length, ring_turn

EQUAL_IN_UNIT_DISC = {3: 1 / (1 + 2 / sqrt(3)), 4: 1 / (1 + sqrt(2))}
"""Largest radius of so many equal discs in a disc of radius 1."""


def row(*radii: float) -> np.ndarray:
    return np.array([radii], dtype=float)


def round_space(radius: float, gap: float = 0.0) -> Space:
    return Space(gap, pi * (radius + gap / 2) ** 2, (2 * radius + gap) ** 2, (2 * radius, 2 * radius), radius)


def rectangle_space(width: float, height: float, gap: float = 0.0) -> Space:
    area = (width + gap) * (height + gap)
    return Space(gap, area, area, (width, height), None)


def fits(space: Space, *radii: float) -> bool:
    return not space.crowded(row(*radii), row(*radii)).item()


@pytest.mark.parametrize("count", [3, 4])
def test_equal_discs_in_a_disc_are_judged_exactly(count):
    best = EQUAL_IN_UNIT_DISC[count]
    assert fits(round_space(1.0), *[best * (1 - 1e-6)] * count)
    assert not fits(round_space(1.0), *[best * (1 + 1e-6)] * count)


def test_two_wide_and_two_narrow_discs_in_a_disc_are_judged_exactly():
    # Two of half the radius touch in the middle; those that fit beside them have a third of it.
    assert fits(round_space(3.0), 1.5 - 1e-6, 1.5 - 1e-6, 1 - 1e-6, 1 - 1e-6)
    assert not fits(round_space(3.0), 1.5, 1.5, 1 + 1e-3, 1 + 1e-3)


def test_a_gap_counts_in_a_ring():
    # Three discs of radius 1 and a gap of 0.5: centres 2.5 apart, 2.5 / sqrt(3) from the middle.
    radius = 1 + 2.5 / sqrt(3)
    assert ring_turn(row(1, 1, 1), radius, 0.5).item() == pytest.approx(2 * pi)


def test_two_discs_in_a_strip_have_their_closed_form():
    # In a strip 10 wide, radii 3 and 4: 3 across at most, so sqrt(49 - 9) along, and both radii.
    assert ladder_length(row(3, 4), 10.0, 0.0).item() == pytest.approx(7 + sqrt(40))


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_zigzag_in_a_strip_is_as_long_as_it_is(count):
    # Discs of radius 1 in a strip 3 wide: 1 across from each to the next, so sqrt(3) along.
    assert ladder_length(row(*[1.0] * count), 3.0, 0.0).item() == pytest.approx(2 + (count - 1) * sqrt(3))


@given(st.integers(0, 2**31), st.sampled_from([0.0, 0.7]))
def test_what_lies_there_fits(seed, gap):
    random = np.random.default_rng(seed)
    width, height = random.uniform(10, 40, 2)
    place = random.uniform(0, 1, (5, 2)) * (width, height)
    rim = np.minimum(place, (width, height) - place).min(1)
    radii: list[float] = []
    # Each disc as wide as the rim and those before it let it be.
    for i in range(5):
        beside = min((hypot(*(place[i] - place[j])) - gap - radii[j] for j in range(i)), default=inf)
        share = 1.0 if i == 4 else random.uniform(0.3, 1)
        free = min(rim[i], beside)
        if free <= 0.01:
            return
        radii.append(share * free)
    assert fits(rectangle_space(width, height, gap), *radii)


@given(st.integers(0, 2**31), st.sampled_from([0.0, 0.7]))
def test_what_lies_in_a_disc_fits(seed, gap):
    random = np.random.default_rng(seed)
    angle, distance = random.uniform(0, 2 * pi, 4), 10 * np.sqrt(random.uniform(0, 1, 4))
    place = np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=1)
    radii: list[float] = []
    for i in range(4):
        beside = min((hypot(*(place[i] - place[j])) - gap - radii[j] for j in range(i)), default=inf)
        free = min(10 - distance[i], beside)
        if free <= 0.01:
            return
        radii.append(random.uniform(0.3, 1) * free)
    assert fits(round_space(10.0, gap), *radii)


def test_density_runs_from_all_of_the_plane_to_the_hexagonal_one():
    found = florian_density(np.array([1e-6, 1.0]))
    assert found == pytest.approx([1.0, pi / sqrt(12)], abs=1e-5)


def test_more_area_than_there_is_does_not_fit():
    assert not fits(rectangle_space(10, 10), *[1.7] * 11)
