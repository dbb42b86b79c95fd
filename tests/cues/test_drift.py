"""A cue by cameras that drifted, against many such cameras."""

import pytest
import torch
from torch import Tensor
from torch.autograd import gradcheck

from multilens import Layout, Lens, LensDefocus, PairStereo, Problem
from multilens.back import Back
from multilens.cues import LimitedCue, LimitedStereo, PairLimits
from multilens.cues.drift import Drift, Drifted, drifted
from multilens.fusion import InverseVariance

LENS = Lens(6.0, (0.5, 3.0), disparity_noise=0.0002, blur_noise=0.0002)
DEPTHS = torch.tensor([400.0, 700.0, 950.0, 1600.0], dtype=torch.float64)
LAYOUT = Layout([[0.0, 0.0], [12.0, 0.0], [0.0, 5.0]], [2.0, 2.0, 2.0], [500.0, 900.0, 1500.0])
DRIFT = Drift(shift=0.02, decentre_um=0.15, focus_dioptre=0.005)


def normal(*shape: int) -> Tensor:
    return torch.randn(*shape, dtype=torch.float64, generator=torch.Generator().manual_seed(0))


def test_the_score_of_drifted_cues_is_the_mean_over_devices_that_trust_their_best_measurement():
    cues = [drifted(cue, DRIFT) for cue in (PairStereo(), LensDefocus())]
    problem = Problem(Back.rectangle(50, 50), [LENS] * 3, DEPTHS, cues=cues)
    trusted = problem.winners(LAYOUT)
    devices = 200_000
    moved, decentred = 0.02 * normal(devices, 3, 2), 0.15e-3 * normal(devices, 3, 2).flip(0)
    vergence = 5e-6 * normal(devices, 3).flip(0)
    total = 0.0
    for z, k in zip(DEPTHS, trusted.tolist(), strict=True):
        measurement = problem.measurements[k]
        noise = ([*PairStereo()(LAYOUT, problem.lenses, DEPTHS), *LensDefocus()(LAYOUT, problem.lenses, DEPTHS)])[k]
        if measurement.cue == "stereo":
            first, second = measurement.lenses
            way = LAYOUT.position[second] - LAYOUT.position[first]
            # Both cameras see the point straight ahead: it is as far off in the image as they and their lenses moved.
            seen = moved * 6.0 / z + decentred * (1 + 6.0 / z)
            along = (seen[:, second] - seen[:, first]) @ way / way.norm()
            bias = z**2 / (6.0 * way.norm()) * along
        else:
            bias = 1 / (1 / z + vergence[:, measurement.lenses[0]]) - z
        own = noise[z == DEPTHS]
        total += (own.square() + bias.square().mean()).item() / len(DEPTHS)
    assert {problem.measurements[k].cue for k in trusted.tolist()} == {"stereo", "defocus"}
    # 200,000 squares of normal numbers have a mean that is 0.3 % off.
    assert problem.score(LAYOUT).item() == pytest.approx(total, rel=0.01)


def test_many_drifted_views_of_one_point_tell_what_a_least_squares_fit_of_them_does():
    lenses, draws, z = [LENS] * 3, 200_000, 950.0
    problem = Problem(
        Back.rectangle(50, 50), lenses, [z], cues=[drifted(PairStereo(), DRIFT)], fusion=InverseVariance()
    )
    # The noise of a pair's difference is that of one lens times the root of two.
    angle = 0.0002 / 6.0 / 2**0.5 * normal(draws, 3, 2)
    moved, decentred = 0.02 * normal(draws, 3, 2).flip(0), 0.15e-3 * normal(draws, 3, 2).roll(7, 0)
    direction = angle + moved / z + decentred * (1 / 6.0 + 1 / z)
    place = LAYOUT.position - LAYOUT.position.mean(0)
    inverse = (direction * place).sum((-2, -1)) / place.square().sum()
    assert problem.score(LAYOUT).item() ** 0.5 == pytest.approx((z**2 * inverse).std().item(), rel=0.01)


def test_nothing_that_drifts_leaves_the_cue_as_it_is():
    cue = PairStereo()
    assert drifted(cue, Drift()) is cue


def test_each_cue_is_immune_to_the_drift_of_the_other():
    moved, refocused = Drift(shift=0.1, decentre_um=1.0), Drift(focus_dioptre=0.1)
    for cue, drift in ((LensDefocus(), moved), (PairStereo(), refocused)):
        errors = drifted(cue, drift)(LAYOUT, [LENS] * 3, DEPTHS)
        assert torch.equal(errors, cue(LAYOUT, [LENS] * 3, DEPTHS))


def test_a_pair_that_fails_still_fails_and_its_smooth_errors_are_no_less():
    cue = drifted(LimitedStereo(PairLimits(max_disparity=0.1)), DRIFT)
    assert isinstance(cue, LimitedCue)
    position = LAYOUT.position.clone().requires_grad_()
    layout = Layout(position, LAYOUT.aperture_radius, LAYOUT.focus)
    errors, smooth = cue(layout, [LENS] * 3, DEPTHS), cue.smooth(layout, [LENS] * 3, DEPTHS)
    failed = errors.isinf()
    assert failed.any()
    assert not failed.all()
    assert (smooth >= errors)[~failed].all()
    (slope,) = torch.autograd.grad(errors[~failed].sum() + smooth.sum(), position)
    assert slope.isfinite().all()


def test_gradients_of_errors_and_of_information():
    cue = Drifted(PairStereo(), DRIFT)

    def both(position: Tensor) -> tuple[Tensor, Tensor]:
        layout = Layout(position, LAYOUT.aperture_radius, LAYOUT.focus)
        return cue(layout, [LENS] * 3, DEPTHS), 1 / cue.information(layout, [LENS] * 3, DEPTHS)

    assert gradcheck(both, LAYOUT.position.clone().requires_grad_())


def test_in_focus_the_thesis_defocus_keeps_a_finite_gradient():
    focus = torch.tensor([[400.0], [900.0], [1500.0]], dtype=torch.float64, requires_grad=True)
    layout = Layout(LAYOUT.position, LAYOUT.aperture_radius, focus)
    for drift in (DRIFT, Drift(shift=0.1)):
        errors = Drifted(LensDefocus(), drift)(layout, [LENS] * 3, DEPTHS)
        (slope,) = torch.autograd.grad(errors.square().sum(), focus)
        assert slope.isfinite().all()


def test_a_negative_drift_is_refused():
    with pytest.raises(ValueError, match="decentre_um must be >= 0 and finite, got -1"):
        Drift(decentre_um=-1.0)
