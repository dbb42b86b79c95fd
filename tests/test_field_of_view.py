"""Fields: who sees how much, against areas, points and hand-worked angles; scores over a field, against angles one by one."""

import math
from dataclasses import replace

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch.autograd import gradcheck

from multilens import (
    Back,
    Design,
    Field,
    Layout,
    Lens,
    LensDefocus,
    LimitedStereo,
    PairLimits,
    PairStereo,
    Problem,
    WorstCase,
    log_depths,
    solve,
)
from multilens.field_of_view import Part


def lens(field_of_view_deg: float | None) -> Lens:
    return Lens(6.0, (0.5, 3.0), field_of_view_deg=field_of_view_deg)


def test_the_edge_is_left_to_those_who_see_so_far():
    field = Field([0.0, 20.0, 50.0], [1.0, 2.0, 1.0])
    assert field.parts([lens(80.0), lens(120.0), lens(24.0)]) == (
        Part((0, 1, 2), 0.25),
        Part((0, 1), 0.5),
        Part((1,), 0.25),
    )


def test_a_lens_sees_to_the_very_edge_of_its_field():
    assert Field([40.0]).parts([lens(80.0)]) == (Part((0,), 1.0),)


def test_where_no_lens_sees_there_is_a_part_without_lenses():
    assert Field([10.0, 70.0]).parts([lens(90.0)]) == (Part((0,), 0.5), Part((), 0.5))


def test_a_lens_of_an_unknown_field_sees_everything():
    assert Field([0.0, 89.0]).parts([lens(None)]) == (Part((0,), 1.0),)


def test_an_angle_without_weight_is_not_asked_for():
    assert Field([10.0, 70.0], [1.0, 0.0]).parts([lens(90.0)]) == (Part((0,), 1.0),)


@given(st.floats(20, 150), st.floats(20, 150), st.integers(1, 40))
def test_the_share_that_a_lens_sees_of_rings_is_that_of_the_area(whole, seen, count):
    parts = Field.rings(whole, count).parts([lens(seen)])
    share = sum(part.share for part in parts if part.lenses)
    area = (math.tan(math.radians(seen / 2)) / math.tan(math.radians(whole / 2))) ** 2
    # Half a ring is lost or won where the lens' edge cuts through one.
    assert share == pytest.approx(min(1, area), abs=0.5001 / count)


def test_rings_are_where_points_spread_evenly_over_an_image_are():
    points = torch.rand(400_000, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0)) * 2 - 1
    radius = points.norm(dim=-1)
    quantiles = radius[radius <= 1].quantile(torch.tensor([1 / 8, 3 / 8, 5 / 8, 7 / 8], dtype=torch.float64))
    tangents = [math.tan(math.radians(angle)) for angle in Field.rings(90.0, 4).angles_deg]
    assert tangents == pytest.approx(quantiles.tolist(), abs=3e-3)


def test_shares_sum_to_one():
    parts = Field.rings(120.0, 7).parts([lens(80.0), lens(30.0)])
    assert sum(part.share for part in parts) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([],), "angles_deg must be at least one number >= 0 and < 90 degrees"),
        (([90.0],), "angles_deg must be at least one number >= 0 and < 90 degrees"),
        (([1.0], [1.0, 2.0]), "weights must be 1 finite numbers >= 0, not all 0, one for each angle"),
        (([1.0], [0.0]), "weights must be 1 finite numbers >= 0, not all 0, one for each angle"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(arguments, message):
    with pytest.raises(ValueError, match=message):
        Field(*arguments)


@pytest.mark.parametrize(("arguments", "message"), [((180.0, 3), "field_of_view_deg"), ((90.0, 0), "count")])
def test_rings_out_of_their_range_are_refused_by_name(arguments, message):
    with pytest.raises(ValueError, match=f"^{message} must be"):
        Field.rings(*arguments)


BACK = Back.rectangle(70, 150)
WIDE = Lens(6.0, (0.5, 2.0), disparity_noise=2e-4, blur_noise=2e-4, field_of_view_deg=80.0)
TELE = Lens(12.0, (0.5, 3.0), disparity_noise=2e-4, blur_noise=2e-4, field_of_view_deg=30.0)
LENSES = [WIDE, TELE, WIDE]
RING = Field([0.0, 10.0, 30.0], [1.0, 2.0, 1.0])
DEPTHS = log_depths(200, 5000, 48)


def layouts(seed: int, batch: int = 3) -> Layout:
    random = torch.Generator().manual_seed(seed)
    position = torch.rand(batch, 3, 2, dtype=torch.float64, generator=random) * 60
    radius = torch.rand(batch, 3, dtype=torch.float64, generator=random) + 0.5
    return Layout(position, radius, torch.rand(batch, 3, 1, dtype=torch.float64, generator=random) * 3000 + 300)


def least_errors(problem: Problem, layout: Layout) -> torch.Tensor:
    """Of every angle by itself, from all measurements, those with a lens that is blind there struck out: [*batch, a, z]."""
    assert problem.field is not None
    rows = []
    for angle in problem.field.angles_deg:
        errors = problem.errors(layout).clone()
        for k, measurement in enumerate(problem.measurements):
            if any((LENSES[i].field_of_view_deg or 180) / 2 < angle for i in measurement.lenses):
                errors[..., k, :] = math.inf
        rows.append(errors.amin(-2))
    return torch.stack(rows, dim=-2)


@given(st.integers(0, 100))
def test_the_score_is_the_mean_over_depths_and_angles_of_the_best_that_sees(seed):
    problem, layout = Problem(BACK, LENSES, DEPTHS, field=RING), layouts(seed)
    over_field = (least_errors(problem, layout).square().mean(-1) * torch.tensor([0.25, 0.5, 0.25])).sum(-1)
    torch.testing.assert_close(problem.score(layout), over_field, rtol=1e-12, atol=0)


def test_the_worst_case_is_that_of_all_depths_and_angles():
    problem, layout = Problem(BACK, LENSES, DEPTHS, field=RING, metric=WorstCase()), layouts(0)
    worst = least_errors(problem, layout).square().amax((-2, -1))
    torch.testing.assert_close(problem.score(layout), worst, rtol=1e-12, atol=0)


@given(st.integers(0, 100))
def test_a_field_that_all_lenses_see_changes_nothing(seed):
    layout = layouts(seed)
    score = Problem(BACK, LENSES, DEPTHS, field=Field.rings(30.0, 4)).score(layout)
    torch.testing.assert_close(score, Problem(BACK, LENSES, DEPTHS).score(layout), rtol=1e-12, atol=0)


def test_where_no_lens_sees_the_guess_is_what_is_left():
    problem = Problem(BACK, LENSES, DEPTHS, field=Field([60.0]), guess=700.0)
    torch.testing.assert_close(problem.score(layouts(0)), torch.full((3,), 700.0**2).double())


def test_one_lens_alone_measures_no_stereo_at_the_edge():
    problem = Problem(BACK, [WIDE, TELE], DEPTHS, cues=[PairStereo()], field=Field([0.0, 30.0], [3.0, 1.0]))
    layout = layouts(0).only([0, 1])
    assert problem.measured(layout).tolist() == [0.75] * 3
    assert problem.prior_error == pytest.approx(DEPTHS.std(correction=0).item())


def test_gradient_over_a_field():
    problem, layout = Problem(BACK, LENSES, DEPTHS, field=RING), layouts(0, 1)
    unknowns = [x.requires_grad_() for x in (layout.position, layout.aperture_radius, layout.focus)]
    assert gradcheck(lambda *x: problem.score(Layout(*x)), unknowns, rtol=1e-4)


def test_a_search_gives_the_edge_of_the_field_to_the_wide_lenses():
    # Stereo alone: the edge needs the two wide lenses far apart, the centre any pair; so they get the diagonal.
    problem = Problem(BACK, LENSES, DEPTHS, cues=[PairStereo()], field=Field([0.0, 30.0]))
    position = solve(problem, starts=8, patience=0, proof=0).layout.position
    assert torch.dist(position[0], position[2]).item() == pytest.approx(math.hypot(69, 149), rel=1e-3)


def test_a_design_with_limits_and_a_field_comes_back_from_its_file(tmp_path):
    cues = [LimitedStereo(PairLimits(0.7, 0.5)), LensDefocus()]
    lenses = [replace(lens, near_focus=150.0) for lens in LENSES]
    design = solve(Problem(BACK, lenses, DEPTHS, cues=cues, field=RING), starts=2, patience=0, proof=0)
    design.save(tmp_path / "design.json")
    problem = Design.load(tmp_path / "design.json").problem
    assert isinstance(problem, Problem)
    assert (problem.cues, problem.field, problem.lenses) == (tuple(cues), RING, tuple(lenses))
