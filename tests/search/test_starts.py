from time import monotonic

import pytest
import torch
from shapely import Point

import multilens as ml
from multilens.search.starts import scattered_starts, tried_places
from multilens.search.variables import Variables


def test_a_longer_list_begins_with_the_shorter(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    few, many = (scattered_starts(crowded, variables, count, seed=3) for count in (7, 40))
    assert torch.equal(many[:7], few)


def test_a_list_may_be_drawn_in_parts(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    whole = scattered_starts(crowded, variables, 12, seed=3)
    parts = [
        scattered_starts(crowded, variables, count, seed=3, first=first) for first, count in ((0, 5), (5, 4), (9, 3))
    ]
    assert torch.equal(torch.cat(parts), whole)


def test_another_seed_gives_other_starts(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    assert not torch.equal(*(scattered_starts(crowded, variables, 4, seed) for seed in (0, 1)))


def test_free_lenses_stand_where_their_smallest_body_fits(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    layout = variables.layout(scattered_starts(crowded, variables, 100, seed=0))
    region = crowded.back.region().buffer(1e-6)
    for lens, places in zip(crowded.lenses[:2], layout.position[:, :2].unbind(1), strict=True):
        assert all(region.covers(Point(*place).buffer(lens.least_body_radius)) for place in places.tolist())


def test_places_are_spread_over_the_back(crowded: ml.Problem) -> None:
    # Of a back in the shape of an L, both arms are used, about as often as they are large.
    tried, room = tried_places(crowded.back, seed=0)
    places = tried[room >= 0]
    upper = (places[:, 1] > 12).double().mean().item()
    region = crowded.back.region()
    share = region.intersection(ml.rectangle(14, 18, centre=(7, 21)).core).area / region.area
    assert upper == pytest.approx(share, abs=0.02)


def test_no_place_has_more_room_than_the_largest_disc() -> None:
    _, room = tried_places(ml.Back.rectangle(30, 12), seed=0)
    assert 5.9 < room.max().item() <= 6


def test_a_back_of_many_edges_is_started_on_quickly() -> None:
    angle = torch.linspace(0, 2 * torch.pi, 2001).double()[:-1]
    rim = torch.stack([40 * angle.cos(), 30 * angle.sin()], dim=-1) * (1 + 0.05 * (9 * angle).cos()).unsqueeze(-1)
    back = ml.Back(ml.polygon([(x, y) for x, y in rim.tolist()]))
    problem = ml.Problem(back, [ml.Lens(1.0, (1.0, 2.0))] * 8, ml.log_depths(200, 900, 8))
    variables = Variables(problem)
    began = monotonic()
    scattered_starts(problem, variables, 32, seed=0)
    # A second is ten times what it takes; a distance to every edge from every place would take minutes.
    assert monotonic() - began < 5


@pytest.mark.parametrize("first", [1, 4, 39])
def test_a_list_may_begin_further_on(crowded: ml.Problem, first: int) -> None:
    variables = Variables(crowded)
    every, later = (
        scattered_starts(crowded, variables, 40, 3),
        scattered_starts(crowded, variables, 40 - first, 3, first),
    )
    assert every[first:].equal(later)
