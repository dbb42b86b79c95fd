import pytest
import torch
from shapely import Point

import multilens as ml
from multilens.search.starts import places_that_fit, scattered_starts
from multilens.search.variables import Variables


def test_a_longer_list_begins_with_the_shorter(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    few, many = (scattered_starts(crowded, variables, count, seed=3) for count in (7, 40))
    assert torch.equal(many[:7], few)


def test_another_seed_gives_other_starts(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    assert not torch.equal(*(scattered_starts(crowded, variables, 4, seed) for seed in (0, 1)))


def test_free_lenses_stand_where_their_smallest_body_fits(crowded: ml.Problem) -> None:
    variables = Variables(crowded)
    layout = variables.layout(scattered_starts(crowded, variables, 100, seed=0))
    region = crowded.back.region().buffer(1e-6)
    for lens, places in zip(crowded.lenses[:2], layout.position[:, :2].unbind(1), strict=True):
        assert all(region.covers(Point(*place).buffer(lens.least_body_radius)) for place in places.tolist())


def test_starts_are_spread_over_the_back(crowded: ml.Problem) -> None:
    # Of a back in the shape of an L, both arms are used, about as often as they are large.
    places = places_that_fit(crowded, 0.01, seed=0)
    upper = (places[:, 1] > 12).double().mean().item()
    region = crowded.back.region()
    share = region.intersection(ml.rectangle(14, 18, centre=(7, 21)).core).area / region.area
    assert upper == pytest.approx(share, abs=0.02)


def test_no_place_is_found_for_a_body_larger_than_the_back(crowded: ml.Problem) -> None:
    assert len(places_that_fit(crowded, 16.0, seed=0)) == 0
