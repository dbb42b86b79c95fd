"""A device is scored as it stands: nothing moves, only what can focus by itself is focused."""

from dataclasses import replace
from math import sqrt
from pathlib import Path

import pytest
import torch

import multilens as ml
from multilens.search.evaluate import evaluate, refocused, unplaced, widened

BACK = ml.Back.rectangle(60.0, 60.0)
LEFT, RIGHT = (10.0, 30.0), (34.0, 30.0)
FIXED = ml.Lens(5.0, (1.5, 1.5), (800.0, 800.0), clearance=2.0, position=LEFT)
SECOND = replace(FIXED, position=RIGHT, focus=(1200.0, 1200.0))
DEPTHS = ml.linear_depths(300, 2000, 200)


def pair(**others: object) -> ml.Problem:
    return ml.Problem(BACK, [FIXED, replace(SECOND, **others)], DEPTHS)


def test_fixed_lenses_score_what_the_formulae_of_the_thesis_give():
    squares = []
    for z in DEPTHS.tolist():
        stereo = z * z / (5.0 * 24.0)
        blurs = [z * abs(z - focus) / (2 * 1.5 * 5.0) for focus in (800.0, 1200.0)]
        squares.append(min(stereo, *blurs) ** 2)
    assert evaluate(pair()).rmse == pytest.approx(sqrt(sum(squares) / len(squares)), rel=1e-12)


def test_nothing_that_is_fixed_changes():
    layout = evaluate(pair()).layout
    assert layout.position.tolist() == [list(LEFT), list(RIGHT)]
    assert layout.aperture_radius.tolist() == [1.5, 1.5]
    assert layout.focus.tolist() == [[800.0], [1200.0]]


def test_a_lens_that_focuses_by_itself_finds_its_best_focus():
    # One lens, depths evenly spread from Z1 to Z2: Zf = 3/4 (Z2^4 - Z1^4) / (Z2^3 - Z1^3), to the error of 2000 samples.
    lens = replace(FIXED, focus=(300.0, 2000.0))
    found = evaluate(ml.Problem(BACK, [lens], ml.linear_depths(300, 2000, 2000)))
    best = 0.75 * (2000**4 - 300**4) / (2000**3 - 300**3)
    assert found.layout.focus.item() == pytest.approx(best, rel=1e-3)


def test_foci_are_the_best_of_a_grid():
    problem = pair()
    free = replace(problem, lenses=[replace(lens, focus=(300.0, 2000.0)) for lens in problem.lenses])
    found = evaluate(free)
    grid = torch.cartesian_prod(*[torch.linspace(300, 2000, 60).double()] * 2)
    tried = ml.Layout(
        found.layout.position.expand(len(grid), 2, 2),
        found.layout.aperture_radius.expand(len(grid), 2),
        grid.unsqueeze(-1),
    )
    assert found.score <= problem.score(tried).min().item() * (1 + 1e-9)


def test_of_a_range_of_apertures_the_widest_is_taken():
    layout = evaluate(pair(aperture_radius=(0.5, 1.25))).layout
    assert layout.aperture_radius.tolist() == [1.5, 1.25]


def test_a_device_that_breaks_a_clearance_is_scored_saved_and_loaded(tmp_path: Path):
    close = evaluate(pair(clearance=30.0))
    assert not close.feasible
    assert close.rmse == evaluate(pair()).rmse
    close.save(tmp_path / "design.json")
    again = ml.Design.load(tmp_path / "design.json")
    assert (again.status, again.score, again.feasible) == ("as given", close.score, False)


def test_a_lens_without_a_place_is_refused_by_its_number():
    problem = pair(position=None)
    assert unplaced(problem) == (1,)
    with pytest.raises(ValueError, match="lens 2 must have a place"):
        evaluate(problem)


def test_a_lens_that_slides_has_no_place():
    assert unplaced(pair(position=(3.0, None))) == (1,)


def test_apertures_that_overlap_are_no_device():
    with pytest.raises(ValueError, match="apertures must not overlap"):
        evaluate(pair(position=(11.0, 30.0), focus=(300.0, 2000.0)))


def test_what_was_chosen_is_known():
    problem = pair(aperture_radius=(0.5, 1.25), focus=(500.0, 900.0))
    assert (widened(problem), refocused(problem)) == ((1,), (1,))
