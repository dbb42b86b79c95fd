from math import sqrt
from time import monotonic

import pytest
import torch

import multilens as ml
from multilens.search.legalise import legalise
from multilens.search.polish import OutOfTimeError, polish
from multilens.search.variables import Variables


def polished(problem: ml.Problem | ml.ScoreProblem, layout: ml.Layout) -> ml.Layout:
    variables = Variables(problem)
    return variables.layout(polish(problem, variables, variables.vector(layout)))


def test_two_lenses_of_a_disc_end_opposite_each_other() -> None:
    lenses = [ml.Lens(1.0, (1.0, 1.0))] * 2
    problem = ml.Problem(ml.Back.disc(10.0), lenses, ml.linear_depths(100, 200, 8), cues=[ml.PairStereo()])
    layout = polished(problem, ml.Layout([[-2.0, 1.0], [3.0, 0.5]], [1.0, 1.0], [150.0, 150.0]))
    assert (layout.position[0] - layout.position[1]).norm().item() == pytest.approx(18.0, abs=1e-7)


def test_the_largest_of_several_terms_is_minimised() -> None:
    # The three largest equal circles in a disc of radius 1 have the radius 1 / (1 + 2 / sqrt(3)).
    problem = ml.ScoreProblem(
        ml.Back.disc(1.0), [ml.Lens(1.0, (0.01, 1.0))] * 3, lambda layout: -layout.aperture_radius
    )
    start = ml.Layout([[0.4, 0.0], [-0.3, 0.4], [-0.2, -0.5]], [0.1, 0.2, 0.15], [1.0, 1.0, 1.0])
    radius = polished(problem, start).aperture_radius
    assert radius.min().item() == pytest.approx(1 / (1 + 2 / sqrt(3)), abs=1e-9)


def test_the_worst_case_of_many_depths_is_minimised() -> None:
    # Of Z abs(Z - Zf) from 500 to 900 mm the two ends are the worst: equal at Zf = (500^2 + 900^2) / (500 + 900).
    lens = ml.Lens(1.0, (1.0, 1.0), position=(0.0, 0.0))
    depths = ml.linear_depths(500, 900, 401)
    problem = ml.Problem(ml.Back.disc(10.0), [lens], depths, cues=[ml.LensDefocus()], metric=ml.WorstCase())
    layout = polished(problem, ml.Layout([[0.0, 0.0]], [1.0], [620.0]))
    assert layout.focus.item() == pytest.approx((500**2 + 900**2) / (500 + 900), abs=1e-6)


def test_a_lens_reaches_a_corner_where_two_edges_meet() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 6), [ml.Lens(1.0, (0.5, 0.5))], lambda layout: -layout.position[..., 0, :].sum(-1)
    )
    layout = polished(problem, ml.Layout([[4.0, 3.0]], [0.5], [1.0]))
    torch.testing.assert_close(layout.position[0], torch.tensor([9.5, 5.5]).double(), rtol=0, atol=1e-8)


def test_a_lens_stays_on_a_back_of_many_edges_all_the_way() -> None:
    # A round back of 200 edges, of which the 16 nearest to a lens are watched: the way to the far side leads past the others.
    angle = torch.linspace(0, 2 * torch.pi, 201).double()[:-1]
    back = ml.Back(ml.polygon([(10 * a.cos().item(), 10 * a.sin().item()) for a in angle]))
    problem = ml.ScoreProblem(back, [ml.Lens(1.0, (0.5, 0.5))], lambda layout: -layout.position[..., 0, 0])
    layout = polished(problem, ml.Layout([[-9.0, 0.5]], [0.5], [1.0]))
    # The corner at (10, 0) between two edges; the inscribed circle of the polygon has the radius 10 cos(pi / 200).
    reach = 10 - 0.5 / torch.cos(torch.tensor(torch.pi / 200, dtype=torch.float64)).item()
    assert layout.position[0, 0].item() == pytest.approx(reach, abs=1e-7)


def test_a_layout_with_nothing_free_stays() -> None:
    lens = ml.Lens(1.0, (1.0, 1.0), focus=(150.0, 150.0), position=(0.0, 0.0))
    problem = ml.Problem(ml.Back.disc(10.0), [lens], ml.linear_depths(100, 200, 8), cues=[ml.LensDefocus()])
    given = ml.Layout([[0.0, 0.0]], [1.0], [150.0])
    layout = polished(problem, given)
    assert torch.equal(layout.position, given.position)
    assert torch.equal(layout.focus, given.focus)


def test_the_deadline_is_kept(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    with pytest.raises(OutOfTimeError):
        polish(crowded, variables, variables.upper / 2, deadline=monotonic() - 1)


@pytest.mark.parametrize("tolerance", [1e-13, 1e-9, 1e-6])
def test_what_comes_out_is_feasible_at_any_tolerance(crowded: ml.Problem, tolerance: float) -> None:
    variables = Variables(crowded)
    x = variables.vector(
        ml.Layout([[5.0, 20.0], [20.0, 6.0], [8.0, 25.0]], [1.0, 1.0, 1.0], [[400.0] * 2, [600.0] * 2, [900.0] * 2])
    )
    layout = variables.layout(polish(crowded, variables, x, tolerance=tolerance))
    assert legalise(crowded, layout)[1].feasible
