"""The score and its gradient without a graph against autograd through the error of every cue at every depth."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import grad, gradcheck

from multilens.closed_form import CHUNK, ClosedForm, differentiable
from multilens.cues import LensDefocus, PairStereo
from multilens.envelope import DepthMoments
from multilens.layout import Layout
from multilens.lens import Lens

ROUNDING = 1e-9
"""Relative to the largest of its kind; sums of fourth powers of the depths cancel."""

WIDE = Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=2e-4)
LONG = Lens(9.0, (0.5, 3.0), disparity_noise=3e-4, blur_noise=1e-4)
TIERED = Lens(6.0, (0.5, 2.0), tiers=2, disparity_noise=2e-4, blur_noise=2e-4)
DEPTHS = 200 * 25 ** torch.linspace(0, 1, 32, dtype=torch.float64)
WEIGHTS = torch.linspace(1, 2, 32, dtype=torch.float64) / 48
MOMENTS = DepthMoments(DEPTHS, WEIGHTS)
BOTH = (PairStereo(), LensDefocus())

cue_sets = pytest.mark.parametrize("cues", [(PairStereo(),), (LensDefocus(),), BOTH], ids=["stereo", "defocus", "both"])
lens_sets = pytest.mark.parametrize("lenses", [[WIDE] * 2, [WIDE, LONG, WIDE], [WIDE, TIERED, LONG]], ids=len)


def drawn(seed: int, lenses: list[Lens], batch: tuple[int, ...] = (3,), tiers: int = 2) -> list[Tensor]:
    random = torch.Generator().manual_seed(seed)
    share = torch.rand(*batch, len(lenses), 3 + tiers, dtype=torch.float64, generator=random)
    size = torch.tensor([70.0, 150.0], dtype=torch.float64)
    parts = share[..., :2] * size, 0.5 + 1.5 * share[..., 2], 200 * 25 ** share[..., 3:]
    return [part.requires_grad_() for part in parts]


def over_depths(layout: Layout, lenses: list[Lens], cues: tuple) -> Tensor:
    errors = torch.cat([cue(layout, lenses, DEPTHS) for cue in cues], dim=-2)
    return (errors.square().amin(-2) * WEIGHTS).sum(-1)


@cue_sets
@lens_sets
@given(st.integers(0, 2**31))
def test_value_is_that_of_the_cues_over_all_depths(lenses: list[Lens], cues: tuple, seed: int) -> None:
    layout = Layout(*drawn(seed, lenses))
    value, _ = ClosedForm(lenses, cues, MOMENTS)(layout)
    torch.testing.assert_close(value, over_depths(layout, lenses, cues), rtol=ROUNDING, atol=0)


@cue_sets
@lens_sets
@given(st.integers(0, 2**31))
def test_slopes_are_those_of_the_cues_over_all_depths(lenses: list[Lens], cues: tuple, seed: int) -> None:
    parts = drawn(seed, lenses)
    _, slopes = ClosedForm(lenses, cues, MOMENTS)(Layout(*parts))
    expected = grad(over_depths(Layout(*parts), lenses, cues).sum(), parts, allow_unused=True)
    for slope, part, other in zip(slopes, parts, expected, strict=True):
        other = torch.zeros_like(part) if other is None else other
        torch.testing.assert_close(slope, other, rtol=ROUNDING, atol=ROUNDING * other.abs().max().item())


@pytest.mark.parametrize("lenses", [[WIDE], [TIERED]], ids=["one tier", "two tiers"])
def test_a_single_lens_has_defocus_alone(lenses: list[Lens]) -> None:
    layout = Layout(*drawn(0, lenses))
    value, (by_position, _, _) = ClosedForm(lenses, BOTH, MOMENTS)(layout)
    torch.testing.assert_close(value, over_depths(layout, lenses, (LensDefocus(),)), rtol=ROUNDING, atol=0)
    assert by_position.count_nonzero() == 0


def test_a_tier_that_no_lens_has_is_not_measured_with() -> None:
    _, (_, _, by_focus) = ClosedForm([WIDE, LONG], BOTH, MOMENTS)(Layout(*drawn(0, [WIDE, LONG], tiers=3)))
    assert by_focus.shape == (3, 2, 3)
    assert by_focus[..., 1:].count_nonzero() == 0


def test_coincident_centres_have_a_finite_slope() -> None:
    position, radius, focus = drawn(0, [WIDE] * 3)
    value, slopes = ClosedForm([WIDE] * 3, BOTH, MOMENTS)(Layout(torch.ones_like(position), radius, focus))
    assert value.isfinite().all()
    assert all(slope.isfinite().all() for slope in slopes)


def test_at_a_tie_of_pairs_one_pair_has_the_slope() -> None:
    # An equilateral triangle: every pair is as long. Lens by lens the slope is that of the one pair that counts.
    position = torch.tensor([[0.0, 0.0], [60.0, 0.0], [30.0, 30 * 3**0.5]], dtype=torch.float64)
    _, (by_position, _, _) = ClosedForm([WIDE] * 3, (PairStereo(),), MOMENTS)(Layout(position, [1.0] * 3, [500.0] * 3))
    # The score falls with the inverse square of the baseline b: dJ/db = -2 J / b, on each of two lenses, along the pair.
    score = (2e-4 / 6 / 60) ** 2 * (DEPTHS**4 * WEIGHTS).sum()
    lengths = by_position.norm(dim=-1).sort().values
    torch.testing.assert_close(lengths, 2 * score / 60 * torch.tensor([0.0, 1.0, 1.0]).double(), rtol=ROUNDING, atol=0)


def test_gradcheck_as_autograd_sees_it() -> None:
    lenses = [WIDE, TIERED]
    # In units in which a score of some 10^2 mm^2 is about 1, as gradcheck's absolute tolerance supposes.
    form = ClosedForm(lenses, BOTH, DepthMoments(DEPTHS[::8], WEIGHTS[::8]))
    assert gradcheck(lambda *parts: differentiable(form, Layout(*parts)) / 100, drawn(1, lenses, (1,)))


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_the_differentiable_one_keeps_the_type(dtype: torch.dtype) -> None:
    parts = [part.detach().to(dtype).requires_grad_() for part in drawn(0, [WIDE, LONG])]
    value = differentiable(ClosedForm([WIDE, LONG], BOTH, MOMENTS), Layout(*parts))
    assert {value.dtype} | {slope.dtype for slope in grad(value.sum(), parts)} == {dtype}


def test_a_batch_of_batches_is_as_each_by_itself() -> None:
    form, parts = ClosedForm([WIDE, TIERED], BOTH, MOMENTS), drawn(2, [WIDE, TIERED], (2, 3))
    value, slopes = form(Layout(*parts))
    for row in range(2):
        alone, alone_slopes = form(Layout(*(part[row] for part in parts)))
        torch.testing.assert_close(value[row], alone, rtol=1e-14, atol=0)
        for slope, other in zip(slopes, alone_slopes, strict=True):
            torch.testing.assert_close(slope[row], other, rtol=1e-14, atol=0)


def test_a_batch_too_large_for_one_go_is_as_each_half_by_itself() -> None:
    form, parts = ClosedForm([WIDE, TIERED], BOTH, MOMENTS), drawn(3, [WIDE, TIERED], (CHUNK + 4,))
    value, slopes = form(Layout(*parts))
    for half in (slice(0, CHUNK // 2), slice(CHUNK // 2, None)):
        alone, alone_slopes = form(Layout(*(part[half] for part in parts)))
        assert value[half].equal(alone)
        assert all(slope[half].equal(other) for slope, other in zip(slopes, alone_slopes, strict=True))


@pytest.mark.parametrize("part", [0, 1, 2], ids=["position", "aperture radius", "focus"])
def test_what_is_no_number_scores_none_and_spoils_no_other_of_the_batch(part: int) -> None:
    parts = [each.detach() for each in drawn(3, [WIDE, LONG, WIDE])]
    whole, _ = ClosedForm([WIDE, LONG, WIDE], BOTH, MOMENTS)(Layout(*parts))
    parts[part][1, 0] = torch.nan
    value, _ = ClosedForm([WIDE, LONG, WIDE], BOTH, MOMENTS)(Layout(*parts))
    assert not value[1].isfinite()
    assert value[[0, 2]].equal(whole[[0, 2]])


def test_an_aperture_of_no_width_measures_nothing_by_defocus() -> None:
    position, radius, focus = (each.detach() for each in drawn(3, [WIDE, LONG]))
    value, _ = ClosedForm([WIDE, LONG], (LensDefocus(),), MOMENTS)(Layout(position, torch.zeros_like(radius), focus))
    assert not value.isfinite().any()
