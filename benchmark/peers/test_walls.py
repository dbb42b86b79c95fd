import numpy as np
import pytest
import torch

import multilens as ml
from benchmark.peers.walls import Walls
from benchmark.problems import blob, disc, island, l_shape, phone, rectangle, two_islands
from multilens.constraints import room_at

BACKS = {
    "rectangle": rectangle,
    "disc": disc,
    "phone": phone,
    "island": island,
    "L": l_shape,
    "two islands": two_islands,
    "blob": blob,
    "rounded line": lambda: ml.Back(ml.rectangle(30, 10, corner=5)),
}


@pytest.fixture(params=BACKS, ids=str)
def back(request: pytest.FixtureRequest) -> ml.Back:
    return BACKS[request.param]()


def places(back: ml.Back, count: int) -> np.ndarray:
    left, top, right, bottom = back.outline.bounds
    return np.random.default_rng(3).uniform([left, top], [right, bottom], (count, 2))


def test_the_least_room_on_the_back_is_the_one_that_shapely_measures(back: ml.Back) -> None:
    point = places(back, 200)
    expected = room_at(back, point[:, 0], point[:, 1])
    on_back = expected > 0
    np.testing.assert_allclose(Walls(back)(point)[0].min(1)[on_back], expected[on_back], atol=1e-9)


def test_no_place_off_the_back_has_room(back: ml.Back) -> None:
    point = places(back, 200)
    expected = room_at(back, point[:, 0], point[:, 1])
    assert (Walls(back)(point)[0].min(1)[expected < 0] < 0).all()


def test_gradients_are_those_of_finite_differences(back: ml.Back) -> None:
    # All limits, so that none changes its place between two points.
    walls, step = Walls(back, most=10**6), 1e-6
    point = places(back, 60)
    room, gradient = walls(point)
    for axis in (0, 1):
        shift = np.eye(2)[axis] * step
        difference = (walls(point + shift)[0] - walls(point - shift)[0]) / (2 * step)
        near = (np.abs(room) < 100) & (np.abs(difference) < 10)
        wrong = np.abs(difference - gradient[..., axis])[near] > 1e-5
        # A few points lie so close to where the nearest edge changes that the difference spans the change.
        assert wrong.mean() < 2e-3


def test_a_keep_out_with_a_notch_is_refused() -> None:
    notched = ml.polygon([(10, 10), (20, 10), (20, 20), (15, 12), (10, 20)])
    with pytest.raises(ValueError, match="convex"):
        Walls(ml.Back.rectangle(40, 40).keep_out("star", notched))


def test_only_so_many_limits_are_given() -> None:
    assert Walls(blob(), most=4)(torch.zeros(3, 2).double().numpy())[0].shape == (3, 4)
