"""The bound against closed forms, exhaustive search and layouts that are known to be feasible."""

from itertools import product
from math import hypot, inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import multilens as ml
from multilens.certificate import certify
from multilens.constraints import room_at

EYE = ml.Lens(1.0, (1.0, 24.0))
MAIN = ml.Lens(6.86, (0.31, 1.93), (200.0, 5000.0), 6.17, 0.000244, 0.000244)
TURN = 3e-4
"""Relative; what the directions between those that are measured may cost the score."""


def value(problem: ml.Problem | ml.ScoreProblem, boxes: int = 400, target: float = inf) -> float:
    found = ml.lower_bound(problem, boxes, target).value
    assert found is not None
    return found


# Closed forms


def test_stereo_alone_is_bounded_by_the_farthest_pair():
    lens = ml.Lens(2.0, (1.0, 5.0))
    problem = ml.Problem(ml.Back.rectangle(70, 150), [lens] * 2, [1000.0], cues=[ml.PairStereo()])
    best = (1000.0**2 / (hypot(68, 148) * 2)) ** 2
    assert best * (1 - TURN) <= value(problem) <= best


def test_one_lens_is_bounded_by_its_best_focus():
    problem = ml.Problem(ml.Back.disc(10), [ml.Lens(1.0, (1.0, 12.0))], ml.linear_depths(20, 50, 64))
    depth = problem.depths
    focus = (depth**3).sum() / (depth**2).sum()
    best = (depth**2 * (depth - focus) ** 2 / 20.0**2).mean().item()
    assert 0.97 * best <= value(problem) <= best


@pytest.mark.parametrize("count", [1, 2, 3])
def test_tiers_of_equal_apertures_are_bounded_by_the_published_score(truths, count):
    lens = ml.Lens(1.0, (0.5, 0.5), tiers=count)
    problem = ml.Problem(ml.Back.disc(10), [lens], ml.linear_depths(200, 2000, 901), cues=[ml.LensDefocus()])
    best = truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]["J"] * 1e12
    # 901 depths stand for all between: the score is off by about 2 / 900 at the ends.
    assert 0.95 * best <= value(problem) <= best * 1.005


def test_two_discs_that_fill_a_disc_are_bounded_closely():
    # Both apertures together are at most the back's radius: 512 shares of it, the best focus of each by exhaustive search.
    depths = ml.linear_depths(20, 50, 48)
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 2, depths)
    z, foci = depths.numpy(), np.linspace(20, 50, 121)
    costs = (z * (z - foci[:, None])) ** 2
    best = inf
    for wide in np.linspace(12.5, 24.0, 93):
        narrow = 25.0 - wide
        stereo = (z**2 / 25.0) ** 2
        one = np.minimum(stereo, costs / (2 * wide) ** 2)
        best = min(best, min(np.minimum(row, costs / (2 * narrow) ** 2).mean(1).min() for row in one))
    # The search is as coarse as 0.25 mm of focus and 0.125 mm of aperture.
    assert 0.9 * best <= value(problem, 2000) <= best


# Exhaustive search


def test_no_layout_of_two_lenses_on_a_coarse_grid_is_better():
    back = ml.Back.rectangle(12, 8).keep_out("flash", ml.disc((6.0, 4.0), 1.0))
    lenses = [ml.Lens(1.0, (1.0, 3.0)), ml.Lens(2.0, (1.0, 2.0), clearance=0.5)]
    problem = ml.Problem(back, lenses, ml.linear_depths(20, 50, 12), gap=0.5)
    places = list(product(range(1, 12), range(1, 8)))
    best = inf
    foci = list(product([26.0, 32.0, 38.0, 44.0], repeat=2))
    for first_radius, second_radius in product([1.0, 2.0, 3.0], [1.0, 2.0]):
        free = [[p for p in places if _room(p) >= radius] for radius in (first_radius, second_radius + 0.5)]
        apart = max((hypot(a[0] - b[0], a[1] - b[1]) for a, b in product(*free)), default=0.0)
        if apart < first_radius + second_radius + 1.0:
            continue
        a, b = next((a, b) for a, b in product(*free) if hypot(a[0] - b[0], a[1] - b[1]) == apart)
        layouts = ml.Layout(
            [[a, b]] * len(foci), [[first_radius, second_radius]] * len(foci), [[[x], [y]] for x, y in foci]
        )
        best = min(best, problem.score(layouts).min().item())
    assert 0 < value(problem) <= best


def _room(place: tuple[int, int]) -> float:
    x, y = place
    return min(x, y, 12 - x, 8 - y, hypot(x - 6, y - 4) - 1)


# Feasible layouts


@settings(max_examples=8)
@given(st.integers(0, 2**31))
def test_no_random_feasible_layout_scores_below(random_region, seed):
    random = np.random.default_rng(seed)
    back = ml.Back(random_region(seed)) if seed % 2 else ml.Back.rounded_rectangle(*random.uniform(30, 90, 2), 5.0)
    count = int(random.integers(1, 6))
    lenses = []
    for _ in range(count):
        least = float(random.uniform(0.2, 2))
        lenses.append(
            ml.Lens(
                float(random.uniform(1, 9)),
                (least, least + float(random.uniform(0, 20))),
                clearance=float(random.uniform(0, 1)),
                disparity_noise=float(random.uniform(0.5, 2)),
                blur_noise=float(random.uniform(0.5, 2)),
                tiers=int(random.integers(1, 3)),
            )
        )
    if count > 2:
        lenses[1] = lenses[0]
    depths = ml.linear_depths(50, float(random.uniform(100, 400)), 40)
    problem = ml.Problem(back, lenses, depths, random.uniform(0, 1, 40).tolist(), gap=0.3)
    found = ml.lower_bound(problem, 32)
    scores = _feasible_scores(problem, random, 40)
    if scores:
        assert found.value is not None
        assert found.value <= min(scores)


def _feasible_scores(problem: ml.Problem, random: np.random.Generator, tries: int) -> list[float]:
    """Place lenses one by one where they fit, open them as far as they go, focus them anywhere."""
    left, top, right, bottom = problem.back.outline.bounds
    scores = []
    for _ in range(tries):
        place, radius = [], []
        for lens in problem.lenses:
            spot = np.array([random.uniform(left, right), random.uniform(top, bottom)])
            room = float(room_at(problem.back, spot[:1], spot[1:])[0])
            beside = [float(np.hypot(*(spot - other))) - body - problem.gap for other, body in place]
            free = min([room, *beside]) - 1e-9
            opened = min(free - lens.clearance, lens.aperture_radius[1])
            if opened < lens.aperture_radius[0]:
                break
            place.append((spot, opened + lens.clearance))
            radius.append(opened)
        if len(radius) < len(problem.lenses):
            continue
        tiers = max(lens.tiers for lens in problem.lenses)
        near, far = problem.focus_range[0]
        focus = [[float(random.uniform(near, far))] * tiers for _ in radius]
        for row, lens in zip(focus, problem.lenses, strict=True):
            row[: lens.tiers] = [float(random.uniform(near, far)) for _ in range(lens.tiers)]
            row[lens.tiers :] = [row[0]] * (tiers - lens.tiers)
        layout = ml.Layout([spot.tolist() for spot, _ in place], radius, focus)
        certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
        assert certificate.feasible
        scores.append(problem.score(layout).item())
    return scores


def test_the_best_known_four_discs_in_a_disc_score_no_less_and_little_more():
    # Two wide lenses side by side, one narrow above and one below: found by search, score 12.8967 mm^2.
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 4, ml.linear_depths(20, 50, 256))
    assert 0.85 * 12.8967 <= value(problem, 1500) <= 12.8967


def test_four_main_cameras_on_a_rectangle_are_bounded_within_a_hundredth():
    # All wide open, two in opposite corners, the foci by exhaustive refinement: found by search, score 1.79985 mm^2.
    problem = ml.Problem(ml.Back.rectangle(70, 150), [MAIN] * 4, ml.log_depths(200, 5000, 512))
    assert 0.99 * 1.79985 <= value(problem, 1000, 1.79985) <= 1.79985


# What it is like


def test_the_plain_bound_never_falls_as_boxes_are_split():
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 3, ml.linear_depths(20, 50, 64))
    values = [value(problem, boxes) for boxes in (1, 64, 512)]
    assert values == sorted(values)


def test_a_bigger_back_does_not_raise_the_bound_of_stereo():
    problems = [
        ml.Problem(ml.Back.rectangle(side, 20), [EYE] * 2, [100.0], cues=[ml.PairStereo()]) for side in (20, 30, 40)
    ]
    values = [value(problem) for problem in problems]
    assert values == sorted(values, reverse=True)


def test_a_locked_pair_has_its_own_baseline():
    lenses = [ml.Lens(1.0, (1.0, 2.0), position=place) for place in ((5.0, 5.0), (8.0, 9.0))]
    problem = ml.Problem(ml.Back.rectangle(20, 20), lenses, [100.0], cues=[ml.PairStereo()])
    assert value(problem) == pytest.approx((100.0**2 / 5) ** 2, rel=TURN)


def test_the_same_question_has_the_same_bound():
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 3, ml.linear_depths(20, 50, 64))
    assert ml.lower_bound(problem, 200) == ml.lower_bound(problem, 200)


def test_a_target_that_is_reached_ends_the_work():
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 3, ml.linear_depths(20, 50, 64))
    low = value(problem, 1)
    found = ml.lower_bound(problem, 4000, low)
    assert (found.value, found.boxes) == (pytest.approx(low), 1)


# Where there is none


def test_a_score_of_ones_own_has_no_bound():
    problem = ml.ScoreProblem(ml.Back.disc(25), [EYE], lambda layout: -layout.aperture_radius)
    assert ml.lower_bound(problem) == ml.Bound(None, "no bound is known for a score of one's own")


def test_a_cue_of_ones_own_has_no_bound_and_is_named():
    class Louder(ml.PairStereo):
        pass

    problem = ml.Problem(ml.Back.disc(25), [EYE] * 2, [100.0], cues=[Louder()])
    assert ml.lower_bound(problem).reason == "no bound is known for the cue Louder"


@pytest.mark.parametrize("radius", [26.0, 13.0])
def test_lenses_that_do_not_fit_have_no_bound(radius):
    problem = ml.Problem(ml.Back.disc(25), [ml.Lens(1.0, (radius, radius))] * 2, [100.0])
    found = ml.lower_bound(problem)
    assert found.value is None
    assert found.reason.startswith("no layout is feasible")


def test_no_boxes_are_refused():
    with pytest.raises(ValueError, match="boxes must be >= 1, got 0"):
        ml.lower_bound(ml.Problem(ml.Back.disc(25), [EYE], [100.0]), 0)


@pytest.mark.parametrize("metric", [ml.MeanSquare(), ml.WorstCase()], ids=["mean", "worst"])
def test_no_bound_is_claimed_where_a_part_of_the_field_is_guessed(metric):
    lens = ml.Lens(6.86, (0.5, 1.93), field_of_view_deg=60)
    field = ml.Field([0, 40])
    problem = ml.Problem(ml.Back.disc(20), [lens] * 2, ml.log_depths(200, 5000, 32), metric=metric, field=field)
    assert ml.lower_bound(problem, 1).value is None


@given(angles=st.lists(st.floats(0, 45), min_size=1, max_size=3), seed=st.integers(0, 99))
@settings(max_examples=20, deadline=None)
def test_no_layout_scores_below_the_bound_with_a_field(angles, seed):
    lenses = [ml.Lens(6.86, (0.5, 1.93), field_of_view_deg=angle) for angle in (90, 60, 30)]
    problem = ml.Problem(ml.Back.disc(20), lenses, ml.log_depths(200, 5000, 16), field=ml.Field(angles))
    random = np.random.default_rng(seed)
    turn = 2 * np.pi * random.random() + np.arange(3) * 2 * np.pi / 3
    place = 18 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    layout = ml.Layout(place.tolist(), [1.93] * 3, random.uniform(200, 5000, 3).tolist())
    assert (ml.lower_bound(problem, 1).value or 0.0) <= problem.score(layout).item()
