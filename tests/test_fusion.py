"""One error of many: least, or by inverse variance, against pairs and sums of information."""

from math import inf

import pytest
import torch
from torch.autograd import grad, gradcheck

from multilens import Back, Best, InverseVariance, Layout, Lens, LensDefocus, PairStereo, Problem, linear_depths
from multilens.cues import NANOMETRE, LimitedStereo, PairLimits

LENS = Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=3e-4)
LONG = Lens(9.0, (0.5, 2.0), disparity_noise=5e-4, blur_noise=3e-4)
DEPTHS = torch.tensor([400.0, 700.0, 1500.0], dtype=torch.float64)
TRIPLE = Layout([[0.0, 0.0], [30.0, 0.0], [0.0, 40.0]], [1.0, 1.5, 2.0], [500.0, 900.0, 2000.0])
PAIR = Layout([[0.0, 0.0], [30.0, 40.0]], [1.0, 1.5], [500.0, 900.0])
FUSED, LEAST = InverseVariance(), Best()


@pytest.mark.parametrize("lenses", [[LENS, LENS], [LENS, LONG]], ids=["equal", "unequal"])
def test_two_lenses_in_stereo_give_back_the_pair(lenses):
    # The noise of a lens is that of the difference of two: each view has half its variance.
    found = FUSED.squared_error([PairStereo()], PAIR, lenses, DEPTHS)
    torch.testing.assert_close(found, PairStereo()(PAIR, lenses, DEPTHS)[0].square(), rtol=1e-12, atol=0)


def test_informations_of_defocus_add():
    lenses = [LENS] * 3
    errors = LensDefocus()(TRIPLE, lenses, DEPTHS)
    found = FUSED.squared_error([LensDefocus()], TRIPLE, lenses, DEPTHS)
    torch.testing.assert_close(1 / found, (errors**-2).sum(0), rtol=1e-12, atol=0)


def test_cues_count_as_independent():
    lenses = [LENS, LONG, LENS]
    each = [1 / FUSED.squared_error([cue], TRIPLE, lenses, DEPTHS) for cue in (PairStereo(), LensDefocus())]
    found = FUSED.squared_error([PairStereo(), LensDefocus()], TRIPLE, lenses, DEPTHS)
    torch.testing.assert_close(1 / found, each[0] + each[1], rtol=1e-12, atol=0)


def test_three_views_tell_less_than_three_pairs_apart_and_more_than_the_best():
    lenses = [LENS] * 3
    pairs = PairStereo()(TRIPLE, lenses, DEPTHS) ** -2
    told = 1 / FUSED.squared_error([PairStereo()], TRIPLE, lenses, DEPTHS)
    assert (told > pairs.amax(0)).all()
    assert (told < pairs.sum(0)).all()


def test_a_depth_in_focus_has_no_error_beyond_a_nanometre_and_no_gradient():
    focus = torch.tensor([[700.0], [900.0]], dtype=torch.float64, requires_grad=True)
    layout = Layout(PAIR.position, PAIR.aperture_radius, focus)
    found = FUSED.squared_error([LensDefocus()], layout, [LENS, LENS], DEPTHS[1:2])
    assert found.item() == pytest.approx(NANOMETRE**2)
    assert grad(found.sum(), focus)[0].isfinite().all()


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("fusion", [LEAST, FUSED])
def test_the_gradient_is_right(fusion, smooth):
    cues = [PairStereo(), LensDefocus()]

    def score(position, radius, focus):
        return fusion.squared_error(cues, Layout(position, radius, focus), [LENS, LONG, LENS], DEPTHS, smooth)

    parts = TRIPLE.position, TRIPLE.aperture_radius, TRIPLE.focus
    assert gradcheck(score, tuple(part.clone().requires_grad_() for part in parts))


def test_where_no_pair_may_be_used_nothing_is_known_unless_it_was_before():
    cue = LimitedStereo(PairLimits(max_disparity=0.3))
    near = torch.tensor([200.0], dtype=torch.float64)
    assert FUSED.squared_error([cue], PAIR, [LENS, LENS], near).item() == inf
    problem = Problem(Back.rectangle(70, 70), [LENS] * 2, near, cues=[cue], fusion=FUSED, guess=30.0)
    assert problem.score(PAIR).item() == pytest.approx(900.0)
    assert problem.measured(PAIR).item() == 0


@pytest.mark.parametrize("fusion", [LEAST, FUSED])
def test_a_guess_is_one_more_measurement(fusion):
    without = Problem(Back.rectangle(70, 70), [LENS] * 2, DEPTHS, fusion=fusion)
    problem = Problem(Back.rectangle(70, 70), [LENS] * 2, DEPTHS, fusion=fusion, guess=2.0)
    told = 1 / without.squared_error(PAIR) + 1 / 4
    torch.testing.assert_close(problem.squared_error(PAIR), 1 / told, rtol=1e-12, atol=0)


def test_fused_errors_are_never_more_than_the_best():
    problem = Problem(Back.rectangle(70, 70), [LENS, LONG, LENS], linear_depths(300, 2000, 101))
    fused = Problem(Back.rectangle(70, 70), [LENS, LONG, LENS], linear_depths(300, 2000, 101), fusion=FUSED)
    # In focus, where the thesis' errors vanish, a fused one counts as a nanometre.
    assert (fused.squared_error(TRIPLE) <= problem.squared_error(TRIPLE) + NANOMETRE**2).all()


@pytest.mark.parametrize("kind", [torch.float64, torch.float32])
@pytest.mark.parametrize("smooth", [False, True])
def test_where_nothing_measures_the_gradient_is_finite(smooth, kind):
    cue = LimitedStereo(PairLimits(max_disparity=0.3))
    # 50 mm apart they measure from 1000 mm on, in a search hardly at first.
    just = 1000 * (1 + 1e-6)
    problem = Problem(Back.rectangle(70, 70), [LENS] * 2, [200.0, just, 1500.0], cues=[cue], fusion=FUSED)
    place = PAIR.position.to(kind).requires_grad_()
    layout = Layout(place, PAIR.aperture_radius.to(kind), PAIR.focus.to(kind))
    score = problem.squared_error(layout, smooth=smooth).sum()
    assert grad(score, place)[0].isfinite().all()
