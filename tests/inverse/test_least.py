"""Least amounts against closed forms."""

from functools import partial
from math import sqrt

import jaxtyping
import pytest

import multilens as ml
from multilens.bounds.bound import Bound
from multilens.inverse.answer import NO_ROOM, NOT_FOUND, PROVED, REACHED, Trial
from multilens.inverse.least import fewest_lenses, smallest_aperture, smallest_back
from multilens.metrics import Relative

QUICK = partial(ml.solve, starts=4, patience=0, proof=0)
PRECISION = 2e-3


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whole searches run without: the tests of each step have the shapes enforced."""
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def pinholes(side: float = 40.0) -> ml.Problem:
    """Two pinholes of radius 1 on a square: b = sqrt(2) (side - 2), err = 1000^2 1e-3 / (b 5) = 200 / b."""
    pinhole = ml.Lens(5.0, (1.0, 1.0), disparity_noise=1e-3)
    return ml.Problem(ml.Back.rectangle(side, side), [pinhole] * 2, [1000.0], cues=[ml.PairStereo()])


def eyes(count: int, span: float = 600.0, most: float = 4.0) -> ml.Problem:
    """Lenses that measure by defocus alone, on a back with room for all: relative error |Z - Zf| / (2 A f / n), f/n 5000."""
    eye = ml.Lens(5.0, (0.5, most), blur_noise=1e-3)
    depths = ml.linear_depths(300, 300 + span, 301)
    return ml.Problem(ml.Back.rectangle(100, 100), [eye] * count, depths, cues=[ml.LensDefocus()])


GOALS = [lambda error: error, lambda error: ml.Tolerance(mm=error), lambda error: ml.Tolerance(percent=error / 10)]
"""The same of a single depth of 1000 mm: a figure, a tolerance in mm, and one in % of the depth."""


@pytest.mark.parametrize("goal", GOALS, ids=["figure", "mm", "percent"])
def test_the_smallest_square_for_two_pinholes(goal):
    answer = smallest_back(pinholes(), goal(200 / (sqrt(2) * 23)), precision=PRECISION, search=QUICK)
    assert answer.value is not None
    assert 25 <= 40 * answer.value <= 25 * (1 + PRECISION)


def test_what_is_smaller_is_proved_to_be_too_small():
    answer = smallest_back(pinholes(), 200 / (sqrt(2) * 23), precision=PRECISION, search=QUICK)
    assert answer.proved_below is not None
    assert 25 * (1 - PRECISION) <= 40 * answer.proved_below < 25


def test_a_back_may_have_to_be_larger_than_it_is():
    answer = smallest_back(pinholes(), 200 / (sqrt(2) * 58), most=2, precision=PRECISION, search=QUICK)
    assert 40 * (answer.value or 0) == pytest.approx(60, rel=PRECISION)


def test_a_back_that_is_not_enough_as_it_is_has_no_answer():
    answer = smallest_back(pinholes(), 200 / (sqrt(2) * 58), search=QUICK)
    (trial,) = answer.trials
    assert (answer.value, answer.design, trial.verdict) == (None, None, PROVED)
    assert trial.figure == pytest.approx(200 / (sqrt(2) * 38), rel=1e-6)


def test_the_smallest_aperture_of_one_lens():
    # Zf* = 3/4 (Z2^4 - Z1^4) / (Z2^3 - Z1^3); the RMSE there is that of A = 1 mm over A.
    problem = eyes(1)
    depths = problem.depths
    focus = (depths**3).sum() / (depths**2).sum()
    at_one = (depths**2 * (depths - focus) ** 2).mean().sqrt().item() / (2 * 1.0 * 5000)
    answer = smallest_aperture(problem, at_one / 1.7, precision=PRECISION, search=QUICK)
    assert answer.value is not None
    assert 1.7 <= answer.value <= 1.7 * (1 + PRECISION)
    assert focus.item() == pytest.approx(3 / 4 * (900**4 - 300**4) / (900**3 - 300**3), rel=2e-3)


def test_the_smallest_aperture_that_keeps_a_tolerance():
    # The worst relative error of one lens is half the range over 2 A f / n, whatever the depths are.
    answer = smallest_aperture(
        eyes(1), ml.Tolerance(percent=100 * 300 / (2 * 2.5 * 5000)), precision=PRECISION, search=QUICK
    )
    assert answer.value is not None
    assert 2.5 <= answer.value <= 2.5 * (1 + PRECISION)


def test_the_smallest_aperture_may_be_the_smallest_there_is():
    answer = smallest_aperture(eyes(1), ml.Tolerance(percent=100), search=QUICK)
    assert (answer.value, len(answer.trials)) == (0.5, 1)


@pytest.mark.parametrize(("percent", "count"), [(0.8, 1), (0.4, 2), (0.27, 3)])
def test_the_fewest_lenses_share_the_range_out_evenly(percent: float, count: int):
    # With k foci the worst relative error is range / (2 k) over 2 A f / n: 600 / 2 / 40000 = 0.75 %, a half of it, a third.
    answer = fewest_lenses(eyes(4), ml.Tolerance(percent=percent), search=QUICK)
    assert answer.value == count
    assert [trial.verdict for trial in answer.trials] == [PROVED] * (count - 1) + [REACHED]


def test_the_goal_is_in_the_unit_of_the_metric():
    # Mean of the relative error over an even range: half of it over sqrt(3) and 2 A f / n, in %.
    problem = eyes(2)
    problem = ml.Problem(problem.back, problem.lenses, problem.depths, cues=problem.cues, metric=Relative())
    one = 100 * 300 / sqrt(3) / 40000
    assert fewest_lenses(problem, 1.01 * one, search=QUICK).value == 1
    assert fewest_lenses(problem, 0.99 * one, search=QUICK).value == 2


def test_a_single_lens_has_no_stereo():
    answer = fewest_lenses(pinholes(), 200 / (sqrt(2) * 37), search=QUICK)
    assert [(trial.value, trial.verdict) for trial in answer.trials] == [(1, PROVED), (2, REACHED)]


def test_counting_ends_where_there_is_no_room():
    # A square of 6 mm holds four bodies of radius 1.5 mm, and no fifth.
    lens = ml.Lens(5.0, (1.5, 1.5), blur_noise=1e-3)
    crowd = ml.Problem(ml.Back.rectangle(6.1, 6.1), [lens], ml.linear_depths(300, 900, 50), cues=[ml.LensDefocus()])
    answer = fewest_lenses(crowd, 1e-3, search=QUICK)
    assert answer.value is None
    assert [trial.value for trial in answer.trials] == [1, 2, 3, 4, 5]
    assert answer.trials[-1].verdict in (NO_ROOM, NOT_FOUND)
    assert answer.trials[-1].design is None


def test_the_design_is_one_of_the_problem_as_it_was_asked():
    answer = smallest_aperture(eyes(1), ml.Tolerance(percent=0.9), precision=0.05, search=QUICK)
    design = answer.design
    assert design is not None
    assert type(design.problem.metric).__name__ == "MeanSquare"
    assert max(design.layout.aperture_radius.tolist()) <= answer.value
    assert design.certificate.feasible


def test_where_no_bound_is_known_nothing_is_proved(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("multilens.inverse.least.lower_bound", lambda *given: Bound(None, "none is known"))
    answer = smallest_back(pinholes(), 200 / (sqrt(2) * 23), precision=0.05, search=QUICK)
    assert 25 <= 40 * (answer.value or 0) <= 25 * 1.06
    assert {trial.verdict for trial in answer.trials if trial.figure} == {REACHED, NOT_FOUND}
    assert "which does not prove that there is none" in str(answer)


def test_whoever_waits_is_told_of_every_trial():
    told: list[Trial] = []
    answer = smallest_back(pinholes(), 200 / (sqrt(2) * 23), precision=0.1, search=QUICK, listener=told.append)
    assert sorted(trial.value for trial in told) == pytest.approx([trial.value for trial in answer.trials], rel=1e-6)


def test_an_answer_in_words():
    answer = fewest_lenses(eyes(2), ml.Tolerance(percent=0.4), search=QUICK)
    assert str(answer).splitlines() == [
        "least lenses for error <= 0.4 % of the depth at every depth",
        "",
        "lenses  largest error / tolerance  none can be below  verdict",
        "1       1.875                      1.875              not enough: proved",
        "2       0.9375                     -                  enough",
        "",
        "enough          2",
        "not enough      1, proved",
    ]


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: fewest_lenses(eyes(1), 0.0), "goal must be > 0 or a tolerance, got 0"),
        (lambda: fewest_lenses(eyes(1), 1.0, most=0), "most must be >= 1 lens, got 0"),
        (lambda: smallest_back(pinholes(), 1.0, most=0.0), "most must be > 0, got 0"),
        (lambda: smallest_back(pinholes(), 1.0, precision=0.0), "precision must be > 0, got 0"),
    ],
)
def test_numbers_out_of_their_range_are_refused(call, told: str):
    with pytest.raises(ValueError, match=f"^{told}$"):
        call()


@pytest.mark.parametrize("find", [fewest_lenses, smallest_back, smallest_aperture])
def test_what_is_asked_of_many_devices_has_no_least(find):
    many = ml.Robust(pinholes(), ml.Disturbance(shift=0.1))
    with pytest.raises(TypeError, match=r"^problem must be a Problem, got a Robust$"):
        find(many, 1.0)
