from dataclasses import replace
from math import log

import numpy as np
import pytest
import torch
from scipy.optimize import approx_fprime
from torch import Tensor

import multilens as ml
from multilens.search.sight import Seer, Sight
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

WIDTH = 0.1


def shares(problem: ml.Problem | ml.ScoreProblem, count: int = 4) -> tuple[Seer, Tensor]:
    variables = Variables(problem)
    seer, share = Seer(problem, variables), variables.spread(scattered_starts(problem, variables, count, seed=2))
    seer.calibrate(share)
    return seer, share


@pytest.fixture
def packing() -> ml.ScoreProblem:
    lens = ml.Lens(1.0, (0.5, 4.0))
    back = ml.Back.rectangle(20, 12).keep_out("flash", ml.disc((7.0, 9.0), 1.5), clearance=0.5)
    return ml.ScoreProblem(back, [lens, replace(lens, clearance=0.5), lens], lambda layout: -layout.aperture_radius)


def by_differences(seer: Seer, share: Tensor, name: str) -> Tensor:
    def ask(vector: np.ndarray) -> np.ndarray:
        sight = seer.look(torch.from_numpy(vector)[None], WIDTH)
        return getattr(sight, name)[0].numpy()

    return torch.from_numpy(np.atleast_2d(approx_fprime(share.numpy(), ask, 1e-7)))


def gradients(seer: Seer, sight: Sight) -> Tensor:
    """Give the gradient of every limit, [b, m, v], by a unit force at each."""
    batch, limits = sight.room.shape
    forces = torch.eye(limits, dtype=torch.float64)
    return torch.stack([seer.gather(sight, force.expand(batch, -1)) for force in forces], dim=1)


@pytest.mark.parametrize("asked", ["crowded", "packing"])
def test_the_slope_is_that_of_the_value(asked: str, request: pytest.FixtureRequest) -> None:
    seer, share = shares(request.getfixturevalue(asked))
    sight = seer.look(share, WIDTH)
    found = torch.cat([by_differences(seer, each, "value") for each in share])
    torch.testing.assert_close(sight.slope, found * seer.free, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("asked", ["crowded", "packing"])
def test_the_gradient_of_each_limit_is_that_of_its_room(asked: str, request: pytest.FixtureRequest) -> None:
    seer, share = shares(request.getfixturevalue(asked))
    sight = seer.look(share, WIDTH)
    found = torch.stack([by_differences(seer, each, "room") for each in share])
    # Edges that limit nothing, as a lens is off the back, have a fixed room and no gradient that would matter.
    counts = sight.room < 0.9 * seer.limits.no_limit / seer.unit
    torch.testing.assert_close(gradients(seer, sight)[counts], (found * seer.free)[counts], rtol=0, atol=1e-5)


def test_the_slope_is_zero_for_what_is_not_free(crowded: ml.Problem) -> None:
    seer, share = shares(crowded)
    assert seer.look(share, WIDTH).slope[:, ~seer.free].count_nonzero() == 0


def test_a_closed_form_has_the_slope_of_a_cue_of_ones_own(crowded: ml.Problem) -> None:
    class Own:
        def measurements(self, lenses):
            return ml.LensDefocus().measurements(lenses)

        def __call__(self, layout, lenses, depths):
            return ml.LensDefocus()(layout, lenses, depths)

    own = ml.Problem(
        crowded.back, crowded.lenses, crowded.depths, crowded.weights, [ml.PairStereo(), Own()], crowded.gap
    )
    (one, share), (other, _) = shares(crowded), shares(own)
    closed, general = one.look(share, WIDTH), other.look(share, WIDTH)
    torch.testing.assert_close(closed.value, general.value, rtol=1e-10, atol=0)
    torch.testing.assert_close(closed.slope, general.slope, rtol=1e-8, atol=1e-9)


def test_along_and_gather_are_adjoint(crowded: ml.Problem, generator: torch.Generator) -> None:
    seer, share = shares(crowded)
    sight = seer.look(share, WIDTH)
    step, force = (
        torch.randn(like.shape, generator=generator, dtype=torch.float64) for like in (sight.share, sight.room)
    )
    there = (seer.along(sight, step) * force).sum(-1)
    torch.testing.assert_close((step * seer.gather(sight, force)).sum(-1), there, rtol=1e-12, atol=0)


def test_curvature_is_the_sum_of_outer_products(crowded: ml.Problem, generator: torch.Generator) -> None:
    seer, share = shares(crowded)
    sight = seer.look(share, WIDTH)
    stiffness = torch.rand(sight.room.shape, generator=generator, dtype=torch.float64)
    each = gradients(seer, sight)
    expected = torch.einsum("bm,bmi,bmj->bij", stiffness, each, each)
    torch.testing.assert_close(seer.curvature(sight, stiffness), expected, rtol=1e-12, atol=1e-12)


def test_where_takes_each_layout_from_one_of_two(crowded: ml.Problem) -> None:
    seer, share = shares(crowded)
    one, other = seer.look(share, WIDTH), seer.look(share.flip(0), WIDTH)
    mixed = one.where(torch.tensor([True, False, True, False]), other)
    for name, part in vars(mixed).items():
        assert part[0].equal(getattr(one, name)[0]), name
        assert part[1].equal(getattr(other, name)[1]), name


@pytest.fixture
def one_depth() -> ml.Problem:
    lens = ml.Lens(5.0, (1.0, 2.0), focus=(200.0, 900.0))
    return ml.Problem(ml.Back.rectangle(10, 10), [lens], [200.0], cues=[ml.LensDefocus()])


def test_of_a_squared_error_the_logarithm_is_minimised(one_depth: ml.Problem) -> None:
    seer, share = shares(one_depth)
    layout = seer.variables.layout_of(share)
    error = 200 * (layout.focus - 200).flatten() / (2 * layout.aperture_radius.flatten() * 5)
    torch.testing.assert_close(seer.look(share, WIDTH).value, 2 * error.log(), rtol=1e-12, atol=0)


def test_an_error_that_falls_to_zero_keeps_a_finite_logarithm(one_depth: ml.Problem) -> None:
    seer, share = shares(one_depth)
    assert seer.look(torch.zeros_like(share), WIDTH).value.tolist() == [log(1e-300)] * 4


def test_a_score_of_ones_own_may_change_its_sign() -> None:
    lens = ml.Lens(1.0, (1.0, 2.0))
    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), [lens], lambda layout: layout.position[..., 0, 0] + 0.0)
    seer, share = shares(problem)
    below = share.index_fill(1, torch.tensor([0]), -0.3)
    assert (seer.look(below, WIDTH).value < 0).all()
    assert (seer.look(below, WIDTH).slope[:, 0] > 0).all()


def test_terms_count_in_units_of_their_size(packing: ml.ScoreProblem) -> None:
    seer, share = shares(packing)
    radius = seer.variables.layout_of(share).aperture_radius
    # The median of the largest of each layout: of four the lower of the middle ones.
    scale = radius.amax(-1).sort().values[1]
    expected = WIDTH * torch.logsumexp(-radius / scale / WIDTH, dim=-1)
    torch.testing.assert_close(seer.look(share, WIDTH).value, expected, rtol=1e-12, atol=0)


def test_what_is_minimised_is_chosen_once(packing: ml.ScoreProblem) -> None:
    seer, share = shares(packing)
    before = seer.look(share, WIDTH).value
    seer.calibrate(share / 3)
    assert seer.look(share, WIDTH).value.equal(before)


def test_room_is_in_units_of_a_quarter_of_the_diagonal() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(12, 16), [ml.Lens(1.0, (1.0, 2.0))], lambda layout: layout.focus[..., 0]
    )
    variables = Variables(problem)
    share = variables.spread(variables.vector(ml.Layout([[4.0, 9.0]], [1.5], [1.0])))
    room = Seer(problem, variables).look(share[None], WIDTH).room
    assert sorted(room.flatten().tolist()) == pytest.approx([2.5 / 5, 5.5 / 5, 6.5 / 5, 7.5 / 5])
