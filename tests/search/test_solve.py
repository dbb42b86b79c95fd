from dataclasses import replace
from itertools import product
from math import hypot, inf
from typing import Any

import jaxtyping
import pytest
import torch
from threadpoolctl import threadpool_limits

import multilens as ml
from multilens.search.descent import DescentSettings
from multilens.search.progress import Progress


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whole searches run without: the tests of each step have the shapes enforced, and it takes three times as long."""
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def packing(back: ml.Back, count: int, most: float) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, [ml.Lens(1.0, (0.01, most))] * count, lambda layout: -layout.aperture_radius)


@pytest.mark.parametrize("count", range(2, 11))
def test_equal_circles_in_the_unit_square(count: int, truths: dict[str, Any]) -> None:
    # Many starts: of ten circles only one in sixteen that are polished becomes the best packing.
    design = ml.solve(packing(ml.Back.rectangle(1, 1), count, 0.5), starts=256, polished=48 if count > 5 else 12)
    published = truths["equal_circles_in_unit_square_radius"][str(count)]
    assert -design.score == pytest.approx(published, abs=1e-6)
    assert design.certificate.feasible


@pytest.mark.parametrize("count", [2, 4, 7])
def test_equal_circles_in_the_unit_disc(count: int, truths: dict[str, Any]) -> None:
    design = ml.solve(packing(ml.Back.disc(1.0), count, 1.0), starts=48, polished=6)
    assert -design.score == pytest.approx(truths["equal_circles_in_unit_circle_radius"][str(count)], abs=1e-6)


@pytest.mark.parametrize("corner", [0.0, 10.0])
def test_the_farthest_pair_of_a_rounded_rectangle(corner: float, truths: dict[str, Any]) -> None:
    lens = ml.Lens(1.0, (1.927, 1.927))
    back = ml.Back.rounded_rectangle(71.5, 147.5, corner)
    problem = ml.Problem(back, [lens] * 3, ml.linear_depths(500, 900, 8), cues=[ml.PairStereo()])
    found, _ = ml.solve(problem, starts=24, polished=4).longest_baseline
    rim = max(corner, 1.927)
    assert found == pytest.approx(hypot(71.5 - 2 * rim, 147.5 - 2 * rim) + 2 * (rim - 1.927), abs=1e-6)
    assert found == pytest.approx(
        truths["stereo_only_farthest_pair_mm"][f"71.5x147.5, corner {corner:g}, aperture 1.927"], abs=1e-3
    )


@pytest.mark.parametrize("count", [1, 2, 3])
def test_foci_of_equal_lenses(count: int, truths: dict[str, Any]) -> None:
    # Of 4,001 depths each stands for a strip of the range, the two at the ends for half a strip.
    depths = ml.linear_depths(200, 2000, 4001)
    weights = torch.ones(4001)
    weights[[0, -1]] = 0.5
    lens = ml.Lens(1.0, (0.5, 0.5))
    problem = ml.Problem(ml.Back.rectangle(10, 10), [lens] * count, depths, weights, cues=[ml.LensDefocus()])
    design = ml.solve(problem, starts=16, polished=3)
    published = truths["defocus_only_equal_apertures"]["0.2-2.0"][str(count)]
    foci = design.layout.focus.flatten().sort().values / 1000
    torch.testing.assert_close(foci, torch.tensor(published["foci"]).double(), rtol=0, atol=2e-4)
    assert design.score / 1e12 == pytest.approx(published["J"], rel=1e-5)


def test_nothing_on_a_grid_is_better() -> None:
    # Two lenses in a narrow box that share its length: a wider aperture costs baseline. Everything on a fine grid is tried.
    back, near, far = ml.Back.rectangle(12, 4), 40.0, 80.0
    lenses = [ml.Lens(1.0, (0.5, 0.5), disparity_noise=0.25), ml.Lens(1.0, (0.5, 2.0), disparity_noise=0.25)]
    problem = ml.Problem(back, lenses, ml.linear_depths(near, far, 33))
    best = inf
    foci = torch.linspace(near, far, 41).double()
    one, other = (grid.flatten() for grid in torch.meshgrid(foci, foci, indexing="ij"))
    for radius, low, high in product(torch.linspace(0.5, 2, 16).tolist(), (0, 1), (0, 1)):
        # For a given radius the longest baseline is between corners of what is left for each centre.
        y = (3.5 if low else 0.5, 4 - radius if high else radius)
        count = len(one)
        layout = ml.Layout(
            torch.tensor([[0.5, y[0]], [12 - radius, y[1]]]).double().expand(count, 2, 2),
            torch.tensor([0.5, radius]).double().expand(count, 2),
            torch.stack([one, other], dim=-1),
        )
        best = min(best, problem.score(layout).min().item())
    assert ml.solve(problem, starts=48, polished=8).score <= best


def test_both_penalties_lead_to_equally_good_designs() -> None:
    back = ml.Back.rounded_rectangle(24, 18, 4).keep_out("flash", ml.disc((12.0, 9.0), 2.0), clearance=0.5)
    lens = ml.Lens(5.0, (0.5, 2.5), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(back, [lens] * 3, ml.log_depths(300, 2000, 64))
    by_distance, by_area = (
        ml.solve(problem, starts=16, polished=6, penalty=penalty) for penalty in (ml.distance_penalty, ml.area_penalty)
    )
    assert by_area.certificate.feasible
    assert by_area.score == pytest.approx(by_distance.score, rel=1e-4)


def test_the_same_seed_gives_the_same_design_to_the_bit(crowded: ml.Problem) -> None:
    one, other = (ml.solve(crowded, starts=8, polished=2, seed=4) for _ in range(2))
    assert torch.equal(one.layout.position, other.layout.position)
    assert torch.equal(one.layout.focus, other.layout.focus)


def test_threads_change_nothing() -> None:
    # Large enough for torch and the linear algebra to share the work among threads, were they left to.
    lens = ml.Lens(5.0, (0.5, 2.0), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(ml.Back.rectangle(40, 30), [lens] * 4, ml.log_depths(300, 2000, 512))
    used, designs = torch.get_num_threads(), []
    try:
        for threads in (1, 2):
            torch.set_num_threads(threads)
            with threadpool_limits(threads):
                designs.append(ml.solve(problem, starts=32, polished=2, descent=DescentSettings(steps=60)))
            assert torch.get_num_threads() == threads
    finally:
        torch.set_num_threads(used)
    assert torch.equal(designs[0].layout.position, designs[1].layout.position)
    assert torch.equal(designs[0].layout.focus, designs[1].layout.focus)


def test_locked_lenses_stay(crowded: ml.Problem) -> None:
    lenses = (replace(crowded.lenses[0], position=(24.0, 6.0)), *crowded.lenses[1:])
    problem = ml.Problem(crowded.back, lenses, crowded.depths, crowded.weights, crowded.cues, crowded.gap)
    design = ml.solve(problem, starts=8, polished=2)
    assert design.layout.position[0].tolist() == [24.0, 6.0]
    assert design.layout.position[2, 1].item() == 25.0
    assert design.feasible


def test_a_larger_back_is_no_worse() -> None:
    def rmse(side: float) -> float:
        lens = ml.Lens(5.0, (0.5, 2.0), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
        return ml.solve(
            ml.Problem(ml.Back.rectangle(side, side), [lens] * 3, ml.log_depths(300, 2000, 48)), starts=16, polished=4
        ).rmse

    assert rmse(14.0) >= rmse(18.0) >= rmse(22.0)


def test_what_cannot_fit_is_a_result_with_a_reason() -> None:
    design = ml.solve(
        ml.ScoreProblem(ml.Back.rectangle(10, 10), [ml.Lens(1.0, (6.0, 7.0))], lambda layout: -layout.aperture_radius)
    )
    assert design.status == "infeasible"
    assert "lens 1 needs a disc of radius 6 mm" in design.reason
    assert not design.feasible


def test_what_is_not_provably_too_much_but_does_not_fit_says_by_how_much() -> None:
    # Two discs of radius 3 have the area and each fits, but their centres would have to lie 6 mm apart in a box of 4 x 4.
    lenses = [ml.Lens(1.0, (3.0, 3.0))] * 2
    design = ml.solve(
        ml.ScoreProblem(ml.Back.rectangle(10, 10), lenses, lambda layout: layout.position[..., 0, 0]),
        starts=8,
        polished=3,
    )
    assert design.status == "infeasible"
    assert design.reason.startswith("no feasible layout found: at best lens")
    # The centres can be sqrt(32) mm apart, and the lack may be shared with the outline.
    assert -design.certificate.tightest.room <= 6 - 32**0.5 + 1e-6


def test_a_time_limit_gives_the_best_so_far(crowded: ml.Problem) -> None:
    design = ml.solve(crowded, starts=64, polished=500, time_limit=6.0)
    assert design.status == "time limit"
    assert design.feasible


def test_progress_is_told(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    design = ml.solve(crowded, starts=8, polished=2, listener=told.append)
    assert [told[0].stage, told[-1].stage] == ["descent", "polish"]
    assert told[-1].done == 1
    assert told[-1].best == pytest.approx(design.score)
    assert all(progress.alive == 8 for progress in told)


def test_no_healthy_start_is_an_error() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], lambda layout: (-layout.aperture_radius[..., 0]).sqrt()
    )
    with pytest.raises(RuntimeError, match="none of the 4 starts stayed healthy"):
        ml.solve(problem, starts=4, polished=1)


@pytest.mark.parametrize(
    ("starts", "polished", "limit"), [(0, 1, None), (4, 0, None), (4, 1, 0.0), (4, 1, float("nan"))]
)
def test_numbers_out_of_range_are_refused(crowded: ml.Problem, starts: int, polished: int, limit: float | None) -> None:
    with pytest.raises(ValueError, match="must be >"):
        ml.solve(crowded, starts=starts, polished=polished, time_limit=limit)
