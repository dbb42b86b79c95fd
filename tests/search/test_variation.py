import pytest
import torch
from torch import Tensor

import multilens as ml
from multilens.search.starts import scattered_starts, tried_places
from multilens.search.variables import Variables
from multilens.search.variation import Varier


def varied(problem: ml.Problem | ml.ScoreProblem, count: int, seed: int = 0) -> tuple[Variables, Tensor, Tensor]:
    """Give the parents and many children."""
    variables = Variables(problem)
    parents = variables.spread(scattered_starts(problem, variables, 3, seed=1))
    tried, room = tried_places(problem.back, 0)
    least = min(lens.least_body_radius for lens in problem.lenses)
    varier = Varier(variables, tried[room >= least], torch.Generator().manual_seed(seed))
    return variables, parents, varier(parents, count)


@pytest.fixture
def plain() -> ml.Problem:
    lenses = [ml.Lens(5.0, (0.5, radius)) for radius in (2.0, 3.0, 4.0)]
    return ml.Problem(ml.Back.rectangle(30, 20), lenses, ml.log_depths(300, 2000, 8))


def test_as_many_as_are_asked_for(crowded: ml.Problem) -> None:
    _, parents, children = varied(crowded, 40)
    assert children.shape == (40, parents.shape[1])


def test_what_is_locked_or_fixed_stays(crowded: ml.Problem) -> None:
    variables, parents, children = varied(crowded, 200)
    free = torch.zeros(parents.shape[1], dtype=torch.bool).index_fill(0, variables.free, True)
    assert children[:, ~free].equal(parents[:1, ~free].expand(200, -1))


def test_every_unknown_is_a_part_of_its_range(crowded: ml.Problem) -> None:
    _, _, children = varied(crowded, 200)
    assert (children >= 0).all()
    assert (children <= 1).all()


def test_the_same_generator_gives_the_same(crowded: ml.Problem) -> None:
    one, other = (varied(crowded, 30, seed=4)[2] for _ in range(2))
    assert one.equal(other)


def test_another_generator_gives_others(crowded: ml.Problem) -> None:
    one, other = (varied(crowded, 30, seed)[2] for seed in (4, 5))
    assert not one.equal(other)


def test_parents_stay_as_they_were(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    _, parents, _ = varied(crowded, 30)
    assert parents.equal(variables.spread(scattered_starts(crowded, variables, 3, seed=1)))


def test_every_child_is_like_a_parent_in_something(plain: ml.Problem) -> None:
    # Positions, radii or foci, one of the three, is a parent's to the bit.
    _, parents, children = varied(plain, 300)
    parts = (slice(0, 6), slice(6, 9), slice(9, 12))
    same = torch.stack([(children[:, None, part] == parents[None, :, part]).all(-1).any(-1) for part in parts], dim=-1)
    assert same.any(-1).all()


def test_every_part_is_changed_in_some(plain: ml.Problem) -> None:
    _, parents, children = varied(plain, 300)
    for part in (slice(0, 6), slice(6, 9), slice(9, 12)):
        same = (children[:, None, part] == parents[None, :, part]).all(-1).any(-1)
        assert 0.1 < same.double().mean() < 0.9


def test_a_lens_that_goes_elsewhere_goes_where_it_fits() -> None:
    lens = ml.Lens(5.0, (1.0, 1.5))
    back = ml.Back(ml.polygon([(0, 0), (30, 0), (30, 12), (14, 12), (14, 30), (0, 30)]))
    problem = ml.ScoreProblem(back, [lens], lambda layout: -layout.aperture_radius)
    variables, parents, children = varied(problem, 300)
    # A place anew is far from the parents' where a shaken one is not.
    position = variables.layout_of(children).position[:, 0]
    far = torch.cdist(position, variables.layout_of(parents).position[:, 0]).amin(-1) > 30 * 0.05 * 5
    assert far.any()
    inside = back.outline.signed_distance(*position[far].numpy().T)
    assert (inside <= -1 + 1e-9).all()


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_children_are_of_their_parents_type(crowded: ml.Problem, dtype: torch.dtype) -> None:
    variables = Variables(crowded, dtype)
    parents = torch.full((2, len(variables.low)), 0.5, dtype=dtype)
    varier = Varier(variables, torch.full((4, 2), 5.0, dtype=torch.float64), torch.Generator().manual_seed(0))
    assert varier(parents, 5).dtype == dtype


def test_a_single_locked_lens_can_only_be_refocused() -> None:
    lens = ml.Lens(5.0, (1.0, 1.0), position=(3.0, 4.0))
    problem = ml.Problem(ml.Back.rectangle(9, 9), [lens], ml.log_depths(300, 2000, 8), cues=[ml.LensDefocus()])
    variables, parents, children = varied(problem, 50)
    assert variables.layout_of(children).position.equal(variables.layout_of(parents[:1]).position.expand(50, 1, 2))
    assert len(children[:, -1].unique()) > 5
