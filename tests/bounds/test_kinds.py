"""Lenses sorted into kinds, and what two of them can be."""

from math import hypot

import numpy as np
import pytest

from multilens import Back, Lens, Problem
from multilens.bounds.kinds import bodies, kinds_of, ordered, pairs_of

FREE = Lens(1.0, (1.0, 3.0))
OTHER = Lens(2.0, (1.0, 2.0), clearance=1.0)
LOCKED = Lens(1.0, (1.0, 3.0), position=(2.0, 2.0))


def problem(*lenses: Lens) -> Problem:
    return Problem(Back.rectangle(20, 20), lenses, [100.0, 200.0])


def test_alike_and_free_lenses_are_one_kind_and_locked_ones_are_not():
    kinds = kinds_of(problem(FREE, OTHER, FREE, LOCKED, LOCKED))
    assert kinds is not None
    assert [kind.columns for kind in kinds] == [(0, 2), (2, 3), (3, 4), (4, 5)]


def test_a_locked_lens_opens_no_wider_than_its_surroundings_let_it():
    kinds = kinds_of(problem(LOCKED))
    assert kinds is not None
    assert kinds[0].aperture[-1] == pytest.approx(2.0)


def test_a_lens_that_fits_nowhere_makes_no_kinds():
    assert kinds_of(problem(Lens(1.0, (11.0, 12.0)))) is None


def test_lenses_of_a_kind_fall_in_order():
    kinds = kinds_of(problem(FREE, FREE, FREE))
    assert kinds is not None
    low, high = ordered(kinds, np.array([[0, 5, 2]]), np.array([[7, 9, 8]]))
    assert (low.tolist(), high.tolist()) == ([[5, 5, 2]], [[7, 7, 7]])


def test_bodies_are_apertures_and_clearances():
    kinds = kinds_of(problem(FREE, OTHER))
    assert kinds is not None
    assert bodies(kinds, np.array([[0, 1024]])).tolist() == [[1.0, 3.0]]


def test_the_longest_baseline_counts_in_units_of_the_pairs_noise():
    kinds = kinds_of(problem(FREE, OTHER))
    assert kinds is not None
    baseline, crowded = pairs_of(kinds, np.array([[0, 0]]), 0.0)
    # Bodies of 1 and 2 mm in opposite corners; angular noises of 1 and 1/2 rad.
    expected = hypot(17, 17) / ((1 + 0.25) / 2) ** 0.5
    assert expected <= baseline.item() <= expected * (1 + 1e-4)
    assert not crowded.item()
