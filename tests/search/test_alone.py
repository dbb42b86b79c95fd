import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import approx_fprime

import multilens as ml
from multilens.search.alone import MOST_EDGES_WATCHED, MOST_PAIRS_WATCHED, MOST_TERMS_WATCHED, Alone
from multilens.search.limits import Limits
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

WIDE = ml.Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=2e-4)
TIERED = ml.Lens(9.0, (0.5, 3.0), (150.0, 6000.0), disparity_noise=3e-4, blur_noise=1e-4, tiers=2)
SLIDING = ml.Lens(6.0, (1.0, 1.0), disparity_noise=2e-4, blur_noise=2e-4, position=(None, 25.0))

each_cues = pytest.mark.parametrize(
    "cues",
    [[ml.PairStereo()], [ml.LensDefocus()], [ml.PairStereo(), ml.LensDefocus()]],
    ids=["stereo", "defocus", "both"],
)


def asked(cues: list, count: int = 3) -> ml.Problem:
    lenses = ([WIDE, TIERED, SLIDING] * count)[:count]
    return ml.Problem(ml.Back.rounded_rectangle(70, 150, 10), lenses, ml.log_depths(200, 5000, 64), cues=cues)


def drawn(problem: ml.Problem | ml.ScoreProblem, seed: int) -> tuple[Alone, Variables, torch.Tensor]:
    variables = Variables(problem)
    random = torch.Generator().manual_seed(seed)
    x = torch.rand(len(variables), dtype=torch.float64, generator=random) * variables.upper
    return Alone(problem, variables), variables, x


@each_cues
@given(st.integers(0, 2**31), st.integers(1, 4))
def test_the_score_is_that_of_the_question_over_all_depths(cues: list, seed: int, count: int) -> None:
    if count == 1 and len(cues) == 1 and isinstance(cues[0], ml.PairStereo):
        return
    problem = asked(cues, count)
    alone, variables, x = drawn(problem, seed)
    value, _ = alone.terms(x.numpy())
    assert value.item() == pytest.approx(problem.score_over_depths(variables.layout(x)).item(), rel=1e-10)


@each_cues
@given(st.integers(0, 2**31))
def test_its_gradient_is_that_of_autograd_over_all_depths(cues: list, seed: int) -> None:
    problem = asked(cues)
    alone, variables, x = drawn(problem, seed)
    _, (found,) = alone.terms(x.numpy())
    x.requires_grad_()
    (expected,) = torch.autograd.grad(problem.score_over_depths(variables.layout(x)), x)
    np.testing.assert_allclose(found, expected.numpy(), rtol=1e-8, atol=1e-9 * expected.abs().max().item())


def test_terms_of_a_score_of_ones_own_have_a_row_of_gradient_each() -> None:
    lens = ml.Lens(1.0, (0.5, 2.5))
    problem = ml.ScoreProblem(ml.Back.rectangle(9, 5), [lens] * 2, lambda layout: -layout.aperture_radius)
    alone, variables, x = drawn(problem, 0)
    assert alone.watch(x.numpy())
    values, gradient = alone.terms(x.numpy())
    np.testing.assert_array_equal(values, -variables.layout(x).aperture_radius.numpy())
    np.testing.assert_array_equal(gradient, [[0, 0, 0, 0, -2, 0], [0, 0, 0, 0, 0, -2]])


def test_of_very_many_terms_the_largest_are_watched_first_and_the_others_when_they_become_so() -> None:
    lens = ml.Lens(1.0, (0.5, 0.5))
    level = torch.linspace(-1, 1, 201, dtype=torch.float64)
    problem = ml.ScoreProblem(
        ml.Back.rectangle(9, 9), [lens], lambda layout: level * (layout.position[..., 0, :1] - 4.5)
    )
    variables = Variables(problem)
    alone, (right, left) = Alone(problem, variables), (np.array([share, 0.5]) for share in (0.9, 0.1))
    assert alone.watch(right)
    assert len(alone.watched) == MOST_TERMS_WATCHED
    assert not alone.watch(right)
    assert alone.watch(left)
    largest = alone.terms(left)[0].max()
    assert largest == pytest.approx(problem.score(variables.layout(torch.from_numpy(left))).item())


def test_room_is_that_of_the_limits(crowded: ml.Problem) -> None:
    alone, variables, x = drawn(crowded, 3)
    room, _ = alone.room(x.numpy())
    expected = Limits(crowded)(variables.layout(x))
    np.testing.assert_allclose(room, np.append(expected.apart, expected.inside.flatten()), rtol=0, atol=1e-12)


@pytest.mark.parametrize("start", range(6))
def test_the_gradient_of_the_room_is_that_of_its_values(crowded: ml.Problem, start: int) -> None:
    variables = Variables(crowded)
    alone = Alone(crowded, variables)
    x = scattered_starts(crowded, variables, 6, seed=2)[start].numpy()
    room, gradient = alone.room(x)
    counts = room < alone.limits.no_limit / 2
    # A step across the edge of a shape would not be a derivative: no start stands that close to one.
    difference = approx_fprime(x, lambda v: alone.room(v)[0], 1e-7)
    np.testing.assert_allclose(gradient[counts], difference[counts], rtol=0, atol=2e-5)


def test_the_worst_limits_are_watched() -> None:
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    outline = ml.polygon(list(zip((10 * np.cos(angle)).tolist(), (8 * np.sin(angle)).tolist(), strict=True)))
    lenses = [ml.Lens(1.0, (0.1, 0.5))] * 12
    problem = ml.ScoreProblem(ml.Back(outline), lenses, lambda layout: -layout.aperture_radius)
    alone, variables, x = drawn(problem, 4)
    room, _ = alone.room(x.numpy())
    assert len(room) == MOST_PAIRS_WATCHED * 12 + MOST_EDGES_WATCHED * 12
    every = Limits(problem)(variables.layout(x))
    worst_pairs = np.sort(every.apart.numpy())[: MOST_PAIRS_WATCHED * 12]
    worst_edges = np.sort(every.inside.numpy(), axis=-1)[:, :MOST_EDGES_WATCHED]
    np.testing.assert_allclose(np.sort(room[: len(worst_pairs)]), worst_pairs, rtol=0, atol=1e-12)
    watched = np.sort(room[len(worst_pairs) :].reshape(12, -1), axis=-1)
    np.testing.assert_allclose(watched, worst_edges, rtol=0, atol=1e-12)
