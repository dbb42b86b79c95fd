from typing import Any

import pytest
import torch

import multilens as ml
from multilens.search.refocus import refocus
from multilens.search.variables import Variables


@pytest.fixture
def equal_lenses() -> ml.Problem:
    """Two fixed equal apertures from 0.2 to 2 m, defocus alone: weighted k-means in one dimension."""
    lenses = [ml.Lens(1000.0, (0.5, 0.5), position=(x, 5.0)) for x in (2.0, 8.0)]
    return ml.Problem(ml.Back.rectangle(10, 10), lenses, ml.linear_depths(200, 2000, 601), cues=[ml.LensDefocus()])


def test_foci_leave_a_rut(equal_lenses: ml.Problem, truths: dict[str, Any]) -> None:
    variables = Variables(equal_lenses)
    # Both lenses near by: no gradient moves a focus past the other.
    rut = variables.vector(ml.Layout([[2.0, 5.0], [8.0, 5.0]], [0.5, 0.5], [210.0, 230.0]))
    found = variables.layout(refocus(equal_lenses, variables, rut)).focus.flatten().sort().values / 1000
    published = truths["defocus_only_equal_apertures"]["0.2-2.0"]["2"]["foci"]
    # As near as the 192 values tried lie to each other: a factor of 10^(1/191), 1.2 %.
    torch.testing.assert_close(found, torch.tensor(published).double(), rtol=0.013, atol=0)


def test_the_score_never_gets_worse(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    for x in torch.rand(5, len(variables), generator=generator, dtype=torch.float64) * variables.upper:
        before, after = (crowded.score(variables.layout(v)) for v in (x, refocus(crowded, variables, x)))
        assert after <= before


def test_only_foci_change(crowded: ml.Problem, generator: torch.Generator) -> None:
    variables = Variables(crowded)
    x = torch.rand(len(variables), generator=generator, dtype=torch.float64) * variables.upper
    before, after = variables.layout(x), variables.layout(refocus(crowded, variables, x))
    assert torch.equal(before.position, after.position)
    assert torch.equal(before.aperture_radius, after.aperture_radius)
