"""The questions of the study: main cameras on a phone's island, asked backwards."""

from functools import partial

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.inverse.answer import Answer

SEARCH = partial(ml.solve, starts=64, patience=4, seed=0, proof=0)
"""The seed was fixed before the first search."""

MOST = 6
"""Lenses that are counted up to."""

GOAL, COUNTS, PRECISION = 5.0, (2, 3, 4), 0.02
"""RMSE, mm, that smaller islands and narrower apertures shall reach, for how many lenses, and how closely it is told."""

TOLERANCES = (ml.Tolerance(mm=20), ml.Tolerance(mm=10), ml.Tolerance(percent=0.4), ml.Tolerance(percent=0.2))


def island(count: int) -> ml.Problem:
    """Give the problem of so many equal main cameras on the island, 200 to 5000 mm."""
    return build_problem(read_given(["experiment=phone_back_island", f"lenses.count={count}"]).config)


def counted() -> Answer:
    """Count up to MOST lenses, by a goal that none of them reaches."""
    return ml.fewest_lenses(island(1), 1.0, MOST, SEARCH)


def smallest_islands() -> dict[int, Answer]:
    """Give the smallest island that reaches the goal, for each number of lenses."""
    return {count: ml.smallest_back(island(count), GOAL, 1.0, PRECISION, SEARCH) for count in COUNTS}


def smallest_apertures() -> dict[int, Answer]:
    """Give the smallest aperture that reaches the goal, for each number of lenses."""
    return {count: ml.smallest_aperture(island(count), GOAL, PRECISION, SEARCH) for count in COUNTS}


def within_tolerance() -> dict[ml.Tolerance, Answer]:
    """Give the fewest lenses that keep a tolerance at every depth."""
    return {tolerance: ml.fewest_lenses(island(1), tolerance, MOST, SEARCH) for tolerance in TOLERANCES}
