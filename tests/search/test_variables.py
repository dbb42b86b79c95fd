import torch

import multilens as ml
from multilens.search.variables import Variables


def test_what_is_locked_or_has_equal_bounds_is_left_out(crowded: ml.Problem) -> None:
    # Places: 2 + 2 + 1, for the third slides along a line; radii: 2, for the third is fixed; foci: 1 + 2 tiers + 1.
    assert len(Variables(crowded)) == 5 + 2 + 4


def test_vector_and_layout_are_inverse(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    x = torch.rand(20, len(variables), generator=generator, dtype=torch.float64) * variables.upper
    torch.testing.assert_close(variables.vector(variables.layout(x)), x, rtol=0, atol=1e-13)


def test_zero_and_upper_are_the_bounds(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    low, high = variables.layout(torch.zeros_like(variables.upper)), variables.layout(variables.upper)
    assert low.position[0].tolist() == [0, 0]
    assert high.position[0].tolist() == [30, 30]
    assert low.aperture_radius.tolist() == [0.5, 0.5, 1.0]
    assert high.aperture_radius.tolist() == [2.0, 3.0, 1.0]
    torch.testing.assert_close(low.focus[:, 0], torch.tensor([200.0, 300.0, 300.0]).double())
    torch.testing.assert_close(high.focus[:, 0], torch.tensor([3000.0, 2000.0, 2000.0]).double())


def test_a_sliding_lens_keeps_its_coordinate(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    x = torch.rand(20, len(variables), generator=generator, dtype=torch.float64)
    assert (variables.layout(x).position[:, 2, 1] == 25).all()


def test_a_lens_without_a_tier_repeats_its_first_focus(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    focus = variables.layout(torch.rand(9, len(variables), generator=generator, dtype=torch.float64)).focus
    assert (focus[:, 0, 0] == focus[:, 0, 1]).all()
    assert (focus[:, 1, 0] != focus[:, 1, 1]).all()


def test_bounds_that_only_double_precision_tells_apart_are_free_in_both(crowded: ml.Problem) -> None:
    lens = ml.Lens(5.0, (1.0, 1.0 + 1e-9), focus=(500.0, 500.0 + 1e-6))
    problem = ml.Problem(crowded.back, [lens] * 2, crowded.depths)
    wide, fine = Variables(problem, torch.float32), Variables(problem)
    assert wide.free.tolist() == fine.free.tolist() == list(range(8))
    layout = wide.layout(wide.vector(fine.layout(fine.upper / 2)))
    assert layout.aperture_radius.tolist() == [1.0, 1.0]
    assert layout.focus.flatten().tolist() == [500.0, 500.0]


def test_layout_passes_gradcheck(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    x = torch.rand(len(variables), generator=generator, dtype=torch.float64).requires_grad_()
    torch.autograd.gradcheck(lambda v: variables.layout(v).focus, x)
    torch.autograd.gradcheck(lambda v: variables.layout(v).position, x)
