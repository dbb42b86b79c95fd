"""The mean of the least squared error in closed form against the plain sum over depths."""

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor
from torch.autograd import grad

from multilens import envelope
from multilens.envelope import DepthMoments

ROUNDING = 1e-9
"""Relative to the score with no V at all that is as flat as the flattest; sums of fourth powers of the depths cancel."""

INFINITE = torch.tensor(torch.inf, dtype=torch.float64)


def summed(gain: Tensor, slope: Tensor, focus: Tensor, depths: Tensor, weights: Tensor) -> Tensor:
    """Ask every cue at every depth."""
    stereo = gain[..., None, None] * depths**2
    defocus = slope.unsqueeze(-1) * depths * (depths - focus.unsqueeze(-1)).abs()
    return (torch.cat([stereo, defocus], dim=-2).amin(-2).square() * weights).sum(-1)


def mean_least_square(gain: Tensor, slope: Tensor, focus: Tensor, moments: DepthMoments) -> list[Tensor]:
    """Ask with a batch of any shape."""
    k, batch = slope.shape[-1], gain.shape
    found = envelope.mean_least_square(
        gain.flatten(), *(each.reshape(gain.numel(), k) for each in (slope, focus)), moments
    )
    return [each.view(batch) if each.ndim == 1 else each.reshape(*batch, k) for each in found]


def drawn(seed: int, lenses: int = 5, batch: tuple[int, ...] = (4,)) -> tuple[Tensor, Tensor, Tensor]:
    """Gain, slopes and foci for depths from 200 to 5000 mm; the slopes are within a factor of 100 of the gain, either side."""
    random = torch.Generator().manual_seed(seed)
    gain = torch.rand(batch, dtype=torch.float64, generator=random) + 0.1
    slope = gain.unsqueeze(-1) * 10 ** (4 * torch.rand(*batch, lenses, dtype=torch.float64, generator=random) - 2)
    return gain, slope, 100 * 80 ** torch.rand(*batch, lenses, dtype=torch.float64, generator=random)


def depths_of(seed: int, count: int = 40) -> tuple[Tensor, Tensor]:
    """Depths from 200 to 5000 mm in no order, and weights of which some are 0."""
    random = torch.Generator().manual_seed(seed + 1)
    depths = 200 * 25 ** torch.rand(count, dtype=torch.float64, generator=random)
    return depths, (torch.rand(count, dtype=torch.float64, generator=random) - 0.2).clamp(min=0)


def assert_both_agree(
    gain: Tensor, slope: Tensor, focus: Tensor, depths: Tensor, weights: Tensor, error: float = ROUNDING
) -> None:
    found, *_ = mean_least_square(gain, slope, focus, DepthMoments(depths, weights))
    expected = summed(gain, slope, focus, depths, weights)
    size = (slope.amin(-1).minimum(gain).square() * (depths**4 * weights).sum()).max().item()
    torch.testing.assert_close(found, expected, rtol=error, atol=error * size)


@given(st.integers(0, 2**31), st.integers(1, 12))
def test_as_the_sum_over_depths(seed: int, lenses: int) -> None:
    assert_both_agree(*drawn(seed, lenses), *depths_of(seed))


@given(st.integers(0, 2**31), st.integers(1, 6))
def test_as_the_sum_without_stereo(seed: int, lenses: int) -> None:
    gain, slope, focus = drawn(seed, lenses)
    assert_both_agree(INFINITE.expand_as(gain), slope, focus, *depths_of(seed))


@given(st.integers(0, 2**31), st.integers(2, 6), st.booleans())
def test_as_the_sum_where_slopes_tie(seed: int, lenses: int, with_stereo: bool) -> None:
    gain, slope, focus = drawn(seed, lenses)
    level = slope[:, :1].expand_as(slope)
    assert_both_agree(gain if with_stereo else INFINITE.expand_as(gain), level, focus, *depths_of(seed))


@given(st.integers(0, 2**31), st.integers(2, 6))
def test_as_the_sum_where_foci_tie(seed: int, lenses: int) -> None:
    gain, slope, focus = drawn(seed, lenses)
    assert_both_agree(gain, slope, focus[:, :1].expand_as(focus), *depths_of(seed))


@given(st.integers(0, 2**31), st.integers(2, 6))
def test_as_the_sum_where_whole_lenses_tie(seed: int, lenses: int) -> None:
    gain, slope, focus = drawn(seed, lenses)
    assert_both_agree(gain, slope[:, :1].expand_as(slope), focus[:, :1].expand_as(focus), *depths_of(seed))


@given(st.integers(0, 2**31), st.integers(1, 6))
def test_as_the_sum_where_slopes_differ_by_rounding(seed: int, lenses: int) -> None:
    gain, slope, focus = drawn(seed, lenses)
    nearly = slope[:, :1] * (1 + 2e-16 * torch.arange(lenses, dtype=torch.float64))
    assert_both_agree(gain, nearly, focus, *depths_of(seed))


@pytest.mark.parametrize("part", [0.01, 0.5, 0.999999, 1.0, 1.000001])
def test_as_the_sum_where_a_v_is_flatter_than_the_line_or_as_steep(part: float) -> None:
    gain, _, focus = drawn(3, 2)
    assert_both_agree(gain, part * gain.unsqueeze(-1).expand(4, 2), focus, *depths_of(3))


def test_as_the_sum_where_a_depth_is_in_focus() -> None:
    depths, weights = depths_of(0)
    gain, slope, _ = drawn(0, 3)
    assert_both_agree(gain, slope, depths[:3].expand(4, 3), depths, weights)


def test_as_the_sum_where_every_focus_is_off_the_depths() -> None:
    gain, slope, _ = drawn(1, 2)
    for focus in (20.0, 50_000.0):
        assert_both_agree(gain, slope, torch.full_like(slope, focus), *depths_of(1))


def test_as_the_sum_at_a_single_depth() -> None:
    one = torch.ones(1, dtype=torch.float64)
    assert_both_agree(*drawn(2), 700 * one, one)


def test_as_the_sum_where_depths_repeat() -> None:
    depths, weights = depths_of(5)
    assert_both_agree(*drawn(5), torch.cat([depths, depths[:9], depths[:9]]), torch.cat([weights, weights[:18]]))


def test_as_the_sum_where_depths_are_more_than_16_bits_count() -> None:
    assert_both_agree(*drawn(5), *depths_of(5, 2**15 + 1))


def test_stereo_alone_is_the_sum_over_depths() -> None:
    gain, depths, weights = drawn(0)[0], *depths_of(0)
    nothing = gain.new_empty(4, 0)
    found, *_ = mean_least_square(gain, nothing, nothing, DepthMoments(depths, weights))
    torch.testing.assert_close(found, gain**2 * (depths**4 * weights).sum(), rtol=1e-14, atol=0)


def test_a_single_layout_is_no_batch() -> None:
    assert_both_agree(*drawn(4, batch=()), *depths_of(4))


def test_a_batch_may_have_two_dimensions() -> None:
    assert_both_agree(*drawn(4, batch=(2, 3)), *depths_of(4))


def test_a_layout_scores_the_same_to_the_bit_alone_and_in_a_batch() -> None:
    gain, slope, focus = drawn(6, batch=(7,))
    moments = DepthMoments(*depths_of(6))
    alone = torch.stack([mean_least_square(*each, moments)[0] for each in zip(gain, slope, focus, strict=True)])
    assert mean_least_square(gain, slope, focus, moments)[0].equal(alone)


@given(st.integers(0, 2**31), st.booleans())
def test_the_derivatives_are_those_of_the_sum(seed: int, with_stereo: bool) -> None:
    gain, slope, focus = drawn(seed)
    gain = gain if with_stereo else INFINITE.expand_as(gain).clone()
    depths, weights = depths_of(seed)
    _, *closed = mean_least_square(gain, slope, focus, DepthMoments(depths, weights))
    unknowns = [x.requires_grad_() for x in (gain, slope, focus)]
    expected = grad(summed(*unknowns, depths, weights).sum(), unknowns)
    for one, other in list(zip(closed, expected, strict=True))[not with_stereo :]:
        torch.testing.assert_close(one, other, rtol=ROUNDING, atol=ROUNDING * other.abs().max().item())


def test_without_stereo_the_derivative_by_the_gain_is_zero() -> None:
    gain, slope, focus = drawn(0)
    _, by_gain, _, _ = mean_least_square(INFINITE.expand_as(gain), slope, focus, DepthMoments(*depths_of(0)))
    assert by_gain.tolist() == [0.0] * 4


def test_the_derivatives_at_a_tie_are_those_of_the_winners() -> None:
    # Two lenses alike: whichever is moved away, the other stays. The shares of both add up to that of one alone.
    moments = DepthMoments(*depths_of(0))
    gain, slope, focus = drawn(0, 1)
    twice, once = (
        mean_least_square(gain, slope.expand(4, count), focus.expand(4, count), moments)[2:] for count in (2, 1)
    )
    for both, alone in zip(twice, once, strict=True):
        torch.testing.assert_close(both.sum(-1, keepdim=True), alone, rtol=1e-12, atol=0)


def test_depths_in_any_order_are_the_same_to_the_bit() -> None:
    depths, weights = depths_of(8)
    order = torch.randperm(len(depths), generator=torch.Generator().manual_seed(0))
    one, other = (
        mean_least_square(*drawn(8), DepthMoments(depths[at], weights[at]))[0] for at in (order, order.flip(0))
    )
    assert one.equal(other)


def test_thousands_of_depths_lose_no_digits() -> None:
    depths = torch.linspace(200, 5000, 50_000, dtype=torch.float64)
    weights = torch.full_like(depths, 1 / 50_000)
    # Steep Vs: what is left of the sums of fourth powers is a millionth of them.
    gain, slope, focus = drawn(9, 4)
    found, *_ = mean_least_square(gain, 100 * slope, focus, DepthMoments(depths, weights))
    torch.testing.assert_close(found, summed(gain, 100 * slope, focus, depths, weights), rtol=1e-9, atol=0)


def test_no_v_counts_for_less_than_nothing() -> None:
    # A single depth in focus: the three moments cancel, and their rounding must not become a negative square.
    depth = torch.tensor([1234.567], dtype=torch.float64)
    moments = DepthMoments(depth, torch.ones(1, dtype=torch.float64))
    assert 0 <= mean_least_square(INFINITE, depth.new_tensor([0.3]), depth, moments)[0].item() < 1e-2


@given(st.integers(0, 2**31), st.sampled_from([1, 2, 40, 20_000]))
def test_depths_are_counted_as_a_binary_search_counts_them(seed: int, count: int) -> None:
    moments = DepthMoments(*depths_of(seed, count))
    at = torch.cat([moments.depths, moments.depths.nextafter(INFINITE), moments.depths.nextafter(-INFINITE)])
    asked = torch.cat([at, at.new_tensor([-torch.inf, 0.0, 1e300, torch.inf])])
    assert moments.count_below(asked).equal(torch.searchsorted(moments.depths, asked))


def test_depths_of_a_range_are_looked_up_by_their_cells() -> None:
    depths = 200 * 25 ** torch.linspace(0, 1, 256, dtype=torch.float64)
    assert DepthMoments(depths, torch.ones_like(depths)).one_a_cell
