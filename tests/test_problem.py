"""What a problem asks, its score against closed forms, cues that fail, and what is no problem."""

from math import inf, nan

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import grad

from multilens import Back, Layout, Lens, LensDefocus, PairStereo, Problem, linear_depths, log_depths
from multilens.cues import LimitedStereo, PairLimits
from multilens.optics.defocus import defocus_band

BACK = Back.rectangle(70, 150)
WIDE = Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=2e-4)
TIERED = Lens(6.0, (0.5, 2.0), tiers=2, disparity_noise=2e-4, blur_noise=2e-4)


def layouts(seed: int, batch: int = 3, lenses: int = 4, tiers: int = 2) -> Layout:
    random = torch.Generator().manual_seed(seed)
    share = torch.rand(batch, lenses, 3 + tiers, dtype=torch.float64, generator=random)
    size = torch.tensor([70.0, 150.0], dtype=torch.float64)
    return Layout(share[..., :2] * size, 0.5 + 1.5 * share[..., 2], 200 * 25 ** share[..., 3:])


def uniform(near: float, far: float, count: int = 4001) -> tuple[Tensor, Tensor]:
    """Depths and weights whose weighted mean is the mean over the range, by the trapezoidal rule."""
    weights = torch.ones(count, dtype=torch.float64)
    weights[0] = weights[-1] = 0.5
    return linear_depths(near, far, count), weights


# Closed forms


@pytest.mark.parametrize(("near", "far"), [(200.0, 2000.0), (300.0, 400.0)])
def test_the_best_single_focus_is_where_the_gradient_vanishes(near, far):
    problem = Problem(BACK, [WIDE], *uniform(near, far), cues=[LensDefocus()])
    best = 3 / 4 * (far**4 - near**4) / (far**3 - near**3)

    def slope(focus: float) -> float:
        at = torch.tensor([[focus]], dtype=torch.float64, requires_grad=True)
        ones = torch.ones(1, dtype=torch.float64)
        (found,) = grad(problem.score(Layout(torch.zeros(1, 2).double(), ones, at)), at)
        return found.item()

    # The score is a parabola in the focus: its slope is linear. The trapezoidal rule leaves a millionth of an interval.
    assert abs(slope(best)) < 1e-6 * abs(slope(near))


def with_foci(foci: list[float], tiered: bool) -> tuple[Problem, Layout]:
    """Defocus alone, 2 A f = 1 mm^2, from 200 to 2000 mm, as that many lenses or as the tiers of one."""
    count = len(foci)
    focus = torch.tensor(foci, dtype=torch.float64, requires_grad=True).reshape((1, count) if tiered else (count, 1))
    lenses = [Lens(1.0, (0.5, 0.5), tiers=count)] if tiered else [Lens(1.0, (0.5, 0.5))] * count
    layout = Layout([[float(i), 1.0] for i in range(len(lenses))], [0.5] * len(lenses), focus)
    return Problem(BACK, lenses, *uniform(200, 2000, 40_001), cues=[LensDefocus()]), layout


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("tiered", [False, True], ids=["lenses", "tiers of one lens"])
def test_the_best_foci_have_the_published_score(truths, count, tiered):
    truth = truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]
    problem, layout = with_foci([1000 * focus for focus in truth["foci"]], tiered)
    # From metres to millimetres. The sum in steps of 0.045 mm is off by the square of a step over that of the range.
    assert problem.score(layout).item() == pytest.approx(truth["J"] * 1e12, rel=1e-8)


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("tiered", [False, True], ids=["lenses", "tiers of one lens"])
def test_the_gradient_turns_at_the_published_foci(truths, count, tiered):
    foci = truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]["foci"]
    # A depth changes hands between two foci as a whole: the gradient knows where the best ones are to a few of the steps of
    # 0.045 mm between the depths.
    for step in (-0.5, 0.5):
        problem, layout = with_foci([1000 * focus + step for focus in foci], tiered)
        (slope,) = grad(problem.score(layout), layout.focus)
        assert (slope * step > 0).all()


def test_the_farthest_pair_alone_decides_stereo():
    problem = Problem(BACK, [WIDE] * 3, *uniform(200, 2000), cues=[PairStereo()])
    layout = Layout([[0.0, 0.0], [30.0, 40.0], [5.0, 5.0]], [1.0] * 3, [300.0] * 3)
    # err = Z^2 n / (b f), whose square has the mean (Z2^5 - Z1^5) / (5 (Z2 - Z1)) times the rest.
    fourth = (2000.0**5 - 200.0**5) / (5 * 1800)
    assert problem.score(layout).item() == pytest.approx(fourth * (2e-4 / (50 * 6)) ** 2, rel=1e-6)


def test_defocus_wins_exactly_in_its_band():
    problem = Problem(BACK, [WIDE] * 2, linear_depths(200, 5000, 961))
    layout = Layout([[0.0, 0.0], [0.0, 40.0]], [1.5, 0.5], [900.0, 4e9])
    near, far = defocus_band(*torch.tensor([900.0, 1.5, 40.0], dtype=torch.float64))
    inside = (problem.depths > near) & (problem.depths < far)
    names = [problem.measurements[winner].label for winner in problem.winners(layout)]
    assert [name == "defocus 1" for name in names] == inside.tolist()


# What is asked


def test_one_lens_has_a_problem_with_both_cues():
    layout = Layout([[1.0, 1.0]], [1.0], [500.0])
    both, defocus = (
        Problem(BACK, [WIDE], log_depths(200, 5000, 32), cues=cues)
        for cues in ([PairStereo(), LensDefocus()], [LensDefocus()])
    )
    assert both.score(layout) == defocus.score(layout)


def test_a_lens_focuses_no_nearer_than_it_can():
    lenses = [Lens(6.0, (0.5, 2.0), near_focus=near) for near in (100.0, 400.0, 9000.0)]
    ranges = Problem(BACK, lenses, [300.0, 900.0]).focus_range
    assert ranges == ((300.0, 900.0), (400.0, 900.0), (9000.0, 9000.0))


def test_focus_range_is_the_lens_own_or_that_of_the_depths():
    problem = Problem(BACK, [WIDE, Lens(6.0, (1.0, 1.0), focus=(100.0, 300.0))], linear_depths(200, 900))
    assert problem.focus_range == ((200.0, 900.0), (100.0, 300.0))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"lenses": []}, "lenses must be at least one"),
        ({"depths": [300.0, -1.0]}, "depths must be"),
        ({"depths": [300.0, nan]}, "depths must be"),
        ({"depths": []}, "depths must be"),
        ({"depths": [1e-300, 300.0]}, "nearest depth must be from 1e-20 to 1e[+]20, got 1e-300"),
        ({"depths": [300.0, 1e300]}, "farthest depth must be from 1e-20 to 1e[+]20, got 1e[+]300"),
        ({"weights": [1.0]}, "weights must be 2"),
        ({"weights": [0.0, 0.0]}, "weights must be 2"),
        ({"weights": [1.0, -1.0]}, "weights must be 2"),
        ({"weights": [1.0, inf]}, "weights must be 2"),
        ({"cues": []}, "cues must give"),
        ({"cues": [PairStereo()]}, "cues must give"),
        ({"gap": -1.0}, "gap must be"),
        ({"gap": nan}, "gap must be"),
        ({"guess": 0.0}, "guess must be"),
        ({"guess": inf}, "guess must be"),
    ],
)
def test_what_is_no_problem_is_refused_by_name(changed, message):
    with pytest.raises(ValueError, match=message):
        Problem(**({"back": BACK, "lenses": [WIDE], "depths": [300.0, 500.0]} | changed))


@pytest.mark.parametrize("lenses", [1, 3])
@pytest.mark.parametrize("ask", [Problem.score, Problem.score_over_depths, Problem.errors])
def test_a_layout_of_other_lenses_is_refused(ask, lenses):
    problem = Problem(BACK, [WIDE] * 2, [300.0])
    with pytest.raises(ValueError, match=f"layout must have 2 lenses of 1 foci, .* got {lenses} of 2"):
        ask(problem, layouts(0, lenses=lenses))


def test_a_layout_of_too_few_foci_is_refused():
    with pytest.raises(ValueError, match="got 1 of 1"):
        Problem(BACK, [TIERED], [300.0]).score(layouts(0, lenses=1, tiers=1))


# Cues that fail, and a guess


FAILING = [LimitedStereo(PairLimits(max_disparity=0.3))]
SLANT = Layout([[0.0, 0.0], [30.0, 40.0]], [1.0, 1.0], [500.0, 500.0])


def test_the_guess_of_what_fails_is_the_spread_of_the_depths():
    # Every depth is nearer than b f / d = 50 * 6 / 0.3 = 1000 mm.
    problem = Problem(BACK, [WIDE] * 2, [300.0, 500.0, 700.0], [1.0, 2.0, 1.0], FAILING)
    assert problem.score(SLANT).item() == pytest.approx((200**2 + 200**2) / 4)


def test_a_single_depth_that_fails_is_wrong_by_itself():
    assert Problem(BACK, [WIDE] * 2, [500.0], cues=FAILING).score(SLANT).item() == pytest.approx(500.0**2)


def test_the_share_that_is_measured_is_by_weight():
    problem = Problem(BACK, [WIDE] * 2, [500.0, 1500.0, 2000.0], [3.0, 2.0, 5.0], FAILING)
    assert problem.measured(SLANT).item() == pytest.approx(0.7)


@given(st.integers(0, 2**31))
def test_what_is_minimised_is_never_less_than_what_is_claimed(seed):
    problem = Problem(BACK, [WIDE] * 4, log_depths(200, 5000, 32), cues=[*FAILING, LensDefocus()])
    layout = layouts(seed)
    assert (problem.terms(layout).amax(-1) >= problem.score(layout) * (1 - 1e-12)).all()


def test_no_guess_stands_in_for_cues_that_cannot_fail():
    assert Problem(BACK, [WIDE] * 2, [500.0, 900.0]).prior_error is None
