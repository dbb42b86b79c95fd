import pytest
import torch

import multilens as ml
from multilens.search.limits import Limits
from multilens.search.packings import packings
from multilens.search.starts import tried_places

LENSES = [ml.Lens(1.0, (1.0, 24.0)), ml.Lens(1.0, (0.5, 6.0), clearance=1.0), ml.Lens(1.5, (2.0, 2.0), tiers=2)]


def packed(lenses: list[ml.Lens], count: int, seed: int = 0) -> tuple[ml.Problem, ml.Layout]:
    problem = ml.Problem(ml.Back.disc(25), lenses, ml.linear_depths(20, 50, 16), gap=0.5)
    generator = torch.Generator().manual_seed(seed)
    return problem, packings(problem, *tried_places(problem.back, 0), count, generator)


def test_every_layout_is_feasible_where_there_is_room() -> None:
    problem, layout = packed([ml.Lens(1.0, (1.0, 3.0), clearance=0.5)] * 3, 32)
    assert Limits(problem)(layout).least.min() >= -1e-9


def test_apertures_keep_their_bounds() -> None:
    _, layout = packed(LENSES, 32)
    for lens, radius in zip(LENSES, layout.aperture_radius.T, strict=True):
        assert lens.aperture_radius[0] <= radius.min() <= radius.max() <= lens.aperture_radius[1]


def test_some_lens_takes_nearly_all_the_room_there_is() -> None:
    _, layout = packed([ml.Lens(1.0, (1.0, 24.0))] * 2, 64)
    # Of the places that were tried some lie within 2 mm of the middle, and a place may hold 2 % less than the best.
    assert layout.aperture_radius.max() > 0.98 * 23


def test_every_layout_is_another() -> None:
    _, layout = packed(LENSES, 16)
    assert len(layout.position.flatten(1).unique(dim=0)) > 8


@pytest.mark.parametrize("seed", [0, 3])
def test_the_same_generator_gives_the_same_layouts(seed: int) -> None:
    (_, one), (_, other) = packed(LENSES, 8, seed), packed(LENSES, 8, seed)
    assert torch.equal(one.position, other.position)
    assert torch.equal(one.aperture_radius, other.aperture_radius)
