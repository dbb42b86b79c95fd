"""The score of a problem against symmetries, its closed form against the sum over depths, and its gradient."""

from math import cos, sin

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import grad, gradcheck

from multilens import Back, Layout, Lens, LensDefocus, PairStereo, Problem, log_depths

BACK = Back.rectangle(70, 150)
WIDE = Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=2e-4)
LONG = Lens(9.0, (0.5, 3.0), disparity_noise=3e-4, blur_noise=1e-4)
TIERED = Lens(6.0, (0.5, 2.0), tiers=2, disparity_noise=2e-4, blur_noise=2e-4)
MIXED = Problem(BACK, [WIDE, LONG, TIERED, WIDE], log_depths(200, 5000, 32))

SYMMETRY = 1e-9
"""Relative; what a score may change by when everything is moved, turned, renamed or measured in another unit."""


def layouts(seed: int, batch: int = 3, lenses: int = 4, tiers: int = 2) -> Layout:
    random = torch.Generator().manual_seed(seed)
    share = torch.rand(batch, lenses, 3 + tiers, dtype=torch.float64, generator=random)
    size = torch.tensor([70.0, 150.0], dtype=torch.float64)
    return Layout(share[..., :2] * size, 0.5 + 1.5 * share[..., 2], 200 * 25 ** share[..., 3:])


# Symmetries


@given(st.integers(0, 2**31), st.floats(-500, 500), st.floats(-500, 500))
def test_moving_all_lenses_changes_nothing(seed, along_x, along_y):
    layout = layouts(seed)
    moved = layout.position + torch.tensor([along_x, along_y], dtype=torch.float64)
    after = MIXED.score(Layout(moved, layout.aperture_radius, layout.focus))
    torch.testing.assert_close(after, MIXED.score(layout), rtol=SYMMETRY, atol=0)


@given(st.integers(0, 2**31), st.floats(-4, 4), st.sampled_from([1.0, -1.0]))
def test_turning_or_mirroring_all_lenses_changes_nothing(seed, angle, mirror):
    layout = layouts(seed)
    turn = torch.tensor([[cos(angle), sin(angle)], [-mirror * sin(angle), mirror * cos(angle)]], dtype=torch.float64)
    after = MIXED.score(Layout(layout.position @ turn, layout.aperture_radius, layout.focus))
    torch.testing.assert_close(after, MIXED.score(layout), rtol=SYMMETRY, atol=0)


@given(st.integers(0, 2**31), st.permutations(range(4)))
def test_naming_the_lenses_in_another_order_changes_nothing(seed, order):
    layout = layouts(seed)
    renamed = Layout(layout.position[:, order], layout.aperture_radius[:, order], layout.focus[:, order])
    problem = Problem(BACK, [MIXED.lenses[i] for i in order], MIXED.depths)
    torch.testing.assert_close(problem.score(renamed), MIXED.score(layout), rtol=SYMMETRY, atol=0)


@given(st.integers(0, 2**31), st.floats(0.01, 100))
def test_another_unit_of_length_scales_the_score_by_its_square(seed, unit):
    def scaled(lens: Lens) -> Lens:
        low, high = lens.aperture_radius
        noise = unit * lens.disparity_noise, unit * lens.blur_noise
        return Lens(unit * lens.focal_length, (unit * low, unit * high), None, 0.0, *noise, tiers=lens.tiers)

    layout = layouts(seed)
    larger = Layout(unit * layout.position, unit * layout.aperture_radius, unit * layout.focus)
    problem = Problem(BACK, [scaled(lens) for lens in MIXED.lenses], unit * MIXED.depths)
    torch.testing.assert_close(problem.score(larger), unit**2 * MIXED.score(layout), rtol=SYMMETRY, atol=0)


@pytest.mark.parametrize("scale", [1e-300, 1e-3, 7.0, 1e300])
def test_the_scale_of_the_weights_does_not_matter(scale):
    weights = torch.linspace(0, 3, 32, dtype=torch.float64)
    one, other = (Problem(BACK, MIXED.lenses, MIXED.depths, by * weights) for by in (1.0, scale))
    torch.testing.assert_close(other.score(layouts(0)), one.score(layouts(0)), rtol=SYMMETRY, atol=0)


def test_a_weight_counts_as_so_many_depths():
    once = Problem(BACK, MIXED.lenses, [300.0, 500.0, 500.0, 500.0])
    weighted = Problem(BACK, MIXED.lenses, [300.0, 500.0], [1, 3])
    torch.testing.assert_close(weighted.score(layouts(0)), once.score(layouts(0)), rtol=SYMMETRY, atol=0)


@given(st.integers(0, 2**31))
def test_a_layout_scores_alike_alone_and_in_a_batch(seed):
    batch = layouts(seed)
    alone = torch.stack([MIXED.score(batch[index]) for index in range(3)])
    torch.testing.assert_close(MIXED.score(batch), alone, rtol=SYMMETRY, atol=0)


@given(st.integers(0, 2**31), st.integers(0, 3))
def test_a_wider_aperture_never_scores_worse(seed, lens):
    layout = layouts(seed)
    wider = layout.aperture_radius.clone()
    wider[:, lens] *= 1.1
    after = MIXED.score(Layout(layout.position, wider, layout.focus))
    assert (after <= MIXED.score(layout) * (1 + SYMMETRY)).all()


# The score, in closed form and over all depths


@given(st.integers(0, 2**31))
def test_the_score_is_the_weighted_mean_of_the_least_squared_errors(seed):
    layout = layouts(seed)
    least = MIXED.errors(layout).gather(-2, MIXED.winners(layout).unsqueeze(-2)).squeeze(-2)
    torch.testing.assert_close(MIXED.score(layout), least.square().mean(-1), rtol=SYMMETRY, atol=0)


cue_sets = pytest.mark.parametrize(
    "cues",
    [[PairStereo()], [LensDefocus()], [PairStereo(), LensDefocus()], [LensDefocus(), PairStereo()]],
    ids=["stereo", "defocus", "both", "both, in the other order"],
)


@cue_sets
@given(st.integers(0, 2**31), st.permutations(range(32)))
def test_both_ways_to_the_score_agree(cues, seed, order):
    weights = torch.rand(32, dtype=torch.float64, generator=torch.Generator().manual_seed(seed)) + 0.1
    problem = Problem(BACK, MIXED.lenses, MIXED.depths[order], weights, cues)
    layout = layouts(seed)
    torch.testing.assert_close(problem.score(layout), problem.score_over_depths(layout), rtol=1e-9, atol=0)


@cue_sets
@given(st.integers(0, 2**31))
def test_both_ways_to_the_gradient_agree(cues, seed):
    problem = Problem(BACK, MIXED.lenses, MIXED.depths, cues=cues)

    def slopes(score) -> list[Tensor]:
        layout = layouts(seed)
        unknowns = [x.requires_grad_() for x in (layout.position, layout.aperture_radius, layout.focus)]
        found = grad(score(Layout(*unknowns)).sum(), unknowns, allow_unused=True)
        return [torch.zeros_like(x) if slope is None else slope for x, slope in zip(unknowns, found, strict=True)]

    for closed, over_depths in zip(slopes(problem.score), slopes(problem.score_over_depths), strict=True):
        # Where sums cancel, an element may be small beside the others of its kind.
        atol = 1e-9 * over_depths.abs().max().item()
        torch.testing.assert_close(closed, over_depths, rtol=1e-9, atol=atol)


class Wrapped:
    """Defocus as a cue of one's own: nothing tells that the score has a closed form."""

    def measurements(self, lenses):
        return LensDefocus().measurements(lenses)

    def __call__(self, layout, lenses, depths):
        return LensDefocus()(layout, lenses, depths)


@pytest.mark.parametrize(
    "cues", [[PairStereo(), LensDefocus(), LensDefocus()], [PairStereo(), Wrapped()]], ids=["a cue twice", "own"]
)
def test_what_has_no_closed_form_is_summed_over_depths(cues):
    problem = Problem(BACK, MIXED.lenses, MIXED.depths, cues=cues)
    assert not problem.is_envelope
    torch.testing.assert_close(problem.score(layouts(0)), MIXED.score(layouts(0)), rtol=SYMMETRY, atol=0)


def test_a_cue_derived_from_one_of_the_thesis_is_asked_for_its_errors():
    class Doubled(LensDefocus):
        def __call__(self, layout, lenses, depths):
            return 2 * super().__call__(layout, lenses, depths)

    one, other = (Problem(BACK, MIXED.lenses, MIXED.depths, cues=[cue()]) for cue in (LensDefocus, Doubled))
    torch.testing.assert_close(other.score(layouts(0)), 4 * one.score(layouts(0)), rtol=SYMMETRY, atol=0)


@pytest.mark.parametrize("way", [Problem.score, Problem.score_over_depths], ids=["closed form", "over depths"])
def test_gradient_in_all_unknowns(way):
    problem = Problem(BACK, [WIDE, LONG, TIERED], log_depths(200, 5000, 5))
    layout = layouts(1, batch=1, lenses=3)
    unknowns = [x.requires_grad_() for x in (layout.position, layout.aperture_radius, layout.focus)]
    # In units in which a score of some 10^2 mm^2 is about 1, as gradcheck's absolute tolerance supposes.
    assert gradcheck(lambda *x: way(problem, Layout(*x)) / 100, unknowns)


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("cues", [[PairStereo()], [PairStereo(), LensDefocus()]], ids=["stereo alone", "both cues"])
def test_gradient_is_finite_at_coincident_centres(cues, dtype):
    problem = Problem(BACK, [WIDE] * 2, log_depths(200, 5000, 32), cues=cues)
    position = torch.ones(2, 2, dtype=dtype, requires_grad=True)
    layout = Layout(position, torch.ones(2, dtype=dtype), torch.full((2,), 500.0, dtype=dtype))
    score = problem.score(layout)
    (slope,) = grad(score, position, allow_unused=True)
    assert score.isfinite()
    assert slope is None or slope.isfinite().all()


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_gradient_is_finite_at_a_depth_in_focus(dtype):
    problem = Problem(BACK, [WIDE], [300.0, 500.0], cues=[LensDefocus()])
    focus = torch.tensor([[500.0]], dtype=dtype, requires_grad=True)
    score = problem.score(Layout(torch.zeros(1, 2, dtype=dtype), torch.ones(1, dtype=dtype), focus))
    (slope,) = grad(score, focus)
    assert slope.isfinite().all()


def test_single_precision_stays_single():
    assert MIXED.score(layouts(0).to(torch.float32)).dtype == torch.float32


def test_a_cue_of_ones_own_takes_part():
    class Ruler:
        def measurements(self, lenses):
            return LensDefocus().measurements(lenses[:1])

        def __call__(self, layout, lenses, depths):
            return layout.position.new_full((*layout.position.shape[:-2], 1, len(depths)), 0.001)

    problem = Problem(BACK, MIXED.lenses, MIXED.depths, cues=[PairStereo(), Ruler()])
    assert problem.score(layouts(0)).tolist() == [pytest.approx(1e-6)] * 3
