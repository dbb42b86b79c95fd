import pytest
import torch

import multilens as ml
from multilens.search.limits import Limits
from multilens.search.tighten import tighten

HAIR = 1e-10
"""mm; what is taken off besides, on a back of 10 mm."""


def square(*radii: tuple[float, float], gap: float = 0.0) -> Limits:
    lenses = [ml.Lens(1.0, bounds) for bounds in radii]
    return Limits(ml.ScoreProblem(ml.Back.rectangle(10, 10), lenses, lambda layout: -layout.aperture_radius, gap))


def radii(limits: Limits, *discs: tuple[float, float, float]) -> list[float]:
    layout = ml.Layout([[x, y] for x, y, _ in discs], [radius for *_, radius in discs], [1.0] * len(discs))
    return tighten(limits, layout).aperture_radius.tolist()


def test_what_has_room_stays_to_the_bit() -> None:
    assert radii(square((0.1, 3.0), (0.1, 3.0)), (2.5, 5.0, 2.0), (7.5, 5.0, 2.25)) == [2.0, 2.25]


def test_two_discs_that_overlap_give_half_each() -> None:
    assert radii(square((0.1, 3.0), (0.1, 3.0)), (3.0, 5.0, 2.5), (7.0, 5.0, 2.0)) == pytest.approx(
        [2.25, 1.75], abs=HAIR
    )


def test_what_one_cannot_give_the_other_gives() -> None:
    assert radii(square((0.1, 3.0), (2.0, 3.0)), (3.0, 5.0, 2.5), (7.0, 5.0, 2.0)) == pytest.approx(
        [2.0, 2.0], abs=HAIR
    )


def test_what_one_can_give_in_part_the_other_gives_besides() -> None:
    # 0.6 mm too much, of which the second can give 0.1.
    assert radii(square((0.1, 3.0), (2.0, 3.0)), (3.0, 5.0, 2.5), (7.0, 5.0, 2.1)) == pytest.approx(
        [2.0, 2.0], abs=HAIR
    )


def test_a_gap_is_kept() -> None:
    assert radii(square((0.1, 3.0), (0.1, 3.0), gap=0.5), (3.0, 5.0, 2.0), (7.0, 5.0, 2.0)) == pytest.approx(
        [1.75, 1.75], abs=HAIR
    )


def test_a_lens_over_the_rim_gives_what_it_lacks() -> None:
    assert radii(square((0.1, 3.0)), (1.75, 5.0, 2.5)) == pytest.approx([1.75], abs=HAIR)


def test_a_lens_gives_no_more_than_its_bound() -> None:
    assert radii(square((1.0, 3.0)), (0.5, 5.0, 2.5)) == [1.0]


def test_what_comes_out_is_feasible_where_it_can_be(crowded: ml.Problem, generator: torch.Generator) -> None:
    # Nearly touching discs in a grid, each with a little too much.
    grid = torch.tensor([[x, y] for x in (2.0, 5.0, 8.0) for y in (2.0, 5.0, 8.0)], dtype=torch.float64)
    limits = square(*[(0.5, 2.0)] * 9)
    radius = 1.5 + 0.4 * torch.rand(20, 9, generator=generator, dtype=torch.float64)
    tight = tighten(limits, ml.Layout(grid.expand(20, 9, 2), radius, torch.ones(20, 9).double()))
    assert (limits(tight).least >= 0).all()
    assert (tight.aperture_radius <= radius).all()


def test_places_and_foci_stay() -> None:
    layout = ml.Layout([[3.0, 5.0], [7.0, 5.0]], [2.5, 2.5], [300.0, 400.0])
    tight = tighten(square((0.1, 3.0), (0.1, 3.0)), layout)
    assert tight.position.equal(layout.position)
    assert tight.focus.equal(layout.focus)


def test_the_layout_that_came_in_is_not_changed() -> None:
    layout = ml.Layout([[3.0, 5.0], [7.0, 5.0]], [2.5, 2.5], [300.0, 400.0])
    tighten(square((0.1, 3.0), (0.1, 3.0)), layout)
    assert layout.aperture_radius.tolist() == [2.5, 2.5]
