import numpy as np
import pytest
import torch
from scipy.optimize import approx_fprime

import multilens as ml
from multilens.constraints import ExactRoom, body_radius, pair_room
from multilens.search.limits import NO_LIMIT, Limits
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables


@pytest.mark.parametrize("start", range(6))
def test_gradient_is_that_of_the_values(crowded: ml.Problem, start: int) -> None:
    variables = Variables(crowded)
    x = scattered_starts(crowded, variables, 6, seed=2)[start]
    limits = Limits(crowded, variables)
    values, gradient = limits(x)
    # A step across the edge of a shape would not be a derivative: no start stands that close to one.
    difference = approx_fprime(x.numpy(), lambda v: limits(torch.from_numpy(v))[0].numpy(), 1e-7)
    np.testing.assert_allclose(gradient[values < NO_LIMIT / 2], difference[values < NO_LIMIT / 2], atol=2e-5)


@pytest.mark.parametrize("start", range(6))
def test_least_room_is_the_least_that_the_constraints_leave(crowded: ml.Problem, start: int) -> None:
    variables = Variables(crowded)
    x = scattered_starts(crowded, variables, 6, seed=4)[start]
    layout = variables.layout(x)
    room = ExactRoom(crowded.back)(layout.position).amin(-1) - body_radius(layout, crowded.lenses)
    least = min(room.min(), pair_room(layout, crowded.lenses, crowded.gap).min())
    assert Limits(crowded, variables)(x)[0].min().item() == pytest.approx(least.item(), abs=1e-12)


def test_a_lens_off_the_back_is_sent_to_the_nearest_edge() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10).keep_out("logo", ml.rectangle(4, 4, centre=(5, 5))),
        [ml.Lens(1.0, (0.5, 1.0))],
        score=lambda layout: -layout.aperture_radius,
    )
    variables = Variables(problem)
    # 0.3 mm inside the left side of the keep-out: to get clear by 0.5 mm it has to go 0.8 mm to the left.
    x = variables.vector(ml.Layout([[3.3, 5.0]], [0.5], [1.0]))
    values, gradient = Limits(problem, variables)(x)
    worst = values.argmin()
    assert values[worst].item() == pytest.approx(-0.8, abs=1e-12)
    assert gradient[worst, :2].tolist() == pytest.approx([-10.0, 0.0])


def test_a_lens_on_the_rim_is_sent_inward() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], score=lambda layout: -layout.aperture_radius
    )
    variables = Variables(problem)
    x = variables.vector(ml.Layout([[0.0, 5.0]], [0.5], [1.0]))
    values, gradient = Limits(problem, variables)(x)
    assert gradient[values.argmin(), :2].tolist() == pytest.approx([10.0, 0.0])
