"""Cues against hand-worked numbers, and who they say takes part."""

import pytest
import torch
from torch.autograd import grad, gradcheck

from multilens import Layout, Lens, LensDefocus, PairStereo
from multilens.cues import Cue

WIDE = Lens(6.0, (0.5, 3.0))
LONG = Lens(12.0, (0.5, 3.0), disparity_noise=0.01, blur_noise=0.02)
TIERED = Lens(6.0, (0.5, 3.0), tiers=3)
DEPTHS = torch.tensor([300.0, 600.0], dtype=torch.float64)


def test_stereo_of_two_equal_lenses_is_the_depth_squared_over_baseline_and_focal_length():
    layout = Layout([[0.0, 0.0], [3.0, 4.0]], [1.0, 1.0], [1.0, 1.0])
    # Centre to centre 5 mm: 300^2 / (5 * 6) and 600^2 / (5 * 6).
    torch.testing.assert_close(PairStereo()(layout, [WIDE, WIDE], DEPTHS), torch.tensor([[3000.0, 12000.0]]).double())


def test_noise_of_unequal_lenses_is_the_root_mean_square_of_their_angles():
    layout = Layout([[0.0, 0.0], [10.0, 0.0]], [1.0, 1.0], [1.0, 1.0])
    angles = (1 / 6.0, 0.01 / 12.0)
    expected = 300.0**2 / 10 * ((angles[0] ** 2 + angles[1] ** 2) / 2) ** 0.5
    assert PairStereo()(layout, [WIDE, LONG], DEPTHS)[0, 0].item() == pytest.approx(expected, rel=1e-12)


def test_stereo_measures_with_every_pair():
    measurements = PairStereo().measurements([WIDE] * 3)
    assert [(m.lenses, m.label) for m in measurements] == [
        ((0, 1), "stereo 1-2"),
        ((0, 2), "stereo 1-3"),
        ((1, 2), "stereo 2-3"),
    ]


def test_stereo_rows_are_in_the_order_of_its_measurements():
    position = torch.rand(4, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0)) * 50
    errors = PairStereo()(Layout(position, torch.ones(4).double(), torch.ones(4).double()), [WIDE] * 4, DEPTHS)
    for row, measurement in zip(errors, PairStereo().measurements([WIDE] * 4), strict=True):
        baseline = torch.dist(*(position[lens] for lens in measurement.lenses))
        torch.testing.assert_close(row, DEPTHS**2 / (6 * baseline))


def test_one_lens_has_no_stereo():
    assert PairStereo()(Layout([[0.0, 0.0]], [1.0], [1.0]), [WIDE], DEPTHS).shape == (0, 2)


def test_coincident_lenses_have_a_finite_error_and_gradient():
    position = torch.zeros(2, 2, dtype=torch.float64, requires_grad=True)
    errors = PairStereo()(Layout(position, torch.ones(2).double(), torch.ones(2).double()), [WIDE] * 2, DEPTHS)
    (slope,) = grad(errors.sum(), position)
    assert errors.isfinite().all()
    assert slope.isfinite().all()


def test_defocus_is_the_distance_from_focus_over_the_aperture():
    layout = Layout([[0.0, 0.0]], [2.0], [400.0])
    # Z |Z - Zf| n / (2 A f) with n = 0.02, A = 2, f = 12.
    expected = [[300 * 100 * 0.02 / 48, 600 * 200 * 0.02 / 48]]
    torch.testing.assert_close(LensDefocus()(layout, [LONG], DEPTHS), torch.tensor(expected, dtype=torch.float64))


def test_every_tier_measures_with_its_own_focus():
    layout = Layout([[0.0, 0.0]], [1.0], [[100.0, 300.0, 600.0]])
    errors = LensDefocus()(layout, [TIERED], DEPTHS)
    assert [(errors[tier] == 0).tolist() for tier in range(3)] == [[False, False], [True, False], [False, True]]


def test_places_of_tiers_that_a_lens_does_not_have_are_not_read():
    layout = Layout([[0.0, 0.0]] * 2, [1.0, 1.0], [[400.0, 300.0, 600.0], [100.0, 200.0, 300.0]])
    assert LensDefocus()(layout, [WIDE, TIERED], DEPTHS).shape == (4, 2)


def test_tiers_are_named_where_there_are_several():
    labels = [m.label for m in LensDefocus().measurements([WIDE, TIERED])]
    assert labels == ["defocus 1", "defocus 2 tier 1", "defocus 2 tier 2", "defocus 2 tier 3"]


@pytest.mark.parametrize("cue", [PairStereo(), LensDefocus()], ids=["stereo", "defocus"])
def test_cues_are_cues(cue):
    assert isinstance(cue, Cue)


@pytest.mark.parametrize("cue", [PairStereo(), LensDefocus()], ids=["stereo", "defocus"])
def test_gradients(cue):
    random = torch.Generator().manual_seed(0)
    unknowns = [
        torch.rand(2, 3, 2, dtype=torch.float64, generator=random) * 50,
        torch.rand(2, 3, dtype=torch.float64, generator=random) + 0.5,
        torch.rand(2, 3, 3, dtype=torch.float64, generator=random) * 500 + 100,
    ]
    lenses, depths = [WIDE, LONG, TIERED], DEPTHS
    assert gradcheck(lambda *x: cue(Layout(*x), lenses, depths), [x.requires_grad_() for x in unknowns], rtol=1e-5)
