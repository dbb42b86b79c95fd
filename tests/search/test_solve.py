from dataclasses import replace
from itertools import product
from math import hypot, inf, isnan
from time import monotonic
from typing import Any

import jaxtyping
import pytest
import torch
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

import multilens as ml
from multilens.certificate import certify
from multilens.search.legalise import legalise
from multilens.search.limits import Limits
from multilens.search.progress import Progress
from multilens.search.tighten import tighten
from multilens.search.variables import Variables


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whole searches run without: the tests of each step have the shapes enforced, and it takes three times as long."""
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def packing(back: ml.Back, count: int, most: float) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, [ml.Lens(1.0, (0.01, most))] * count, lambda layout: -layout.aperture_radius)


def small(back: ml.Back | None = None, count: int = 3) -> ml.Problem:
    """A question that is searched in a second: round corners, a keep-out, and lenses that compete for room."""
    rounded = ml.Back.rounded_rectangle(24, 18, 4).keep_out("flash", ml.disc((12.0, 9.0), 2.0), clearance=0.5)
    lens = ml.Lens(5.0, (0.5, 2.5), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)
    return ml.Problem(back or rounded, [lens] * count, ml.log_depths(300, 2000, 64))


class OwnDefocus:
    """Defocus as a cue of one's own: nothing in closed form is known of it."""

    def measurements(self, lenses):
        return ml.LensDefocus().measurements(lenses)

    def __call__(self, layout, lenses, depths):
        return ml.LensDefocus()(layout, lenses, depths)


@pytest.mark.parametrize("count", range(2, 11))
def test_equal_circles_in_the_unit_square(count: int, truths: dict[str, Any]) -> None:
    design = ml.solve(packing(ml.Back.rectangle(1, 1), count, 0.5), starts=16, patience=2)
    published = truths["equal_circles_in_unit_square_radius"][str(count)]
    # The polish leaves 1e-10 of the diagonal beside every rim.
    assert -design.score == pytest.approx(published, abs=1e-9)
    assert design.certificate.feasible


@pytest.mark.parametrize(("count", "radius"), [(2, 1 / 2), (4, 1 / (1 + 2**0.5)), (7, 1 / 3)])
def test_equal_circles_in_the_unit_disc(count: int, radius: float) -> None:
    design = ml.solve(packing(ml.Back.disc(1.0), count, 1.0), starts=16, patience=2)
    assert -design.score == pytest.approx(radius, abs=1e-9)


@pytest.mark.parametrize("corner", [0.0, 10.0])
def test_the_farthest_pair_of_a_rounded_rectangle(corner: float, truths: dict[str, Any]) -> None:
    lens = ml.Lens(1.0, (1.927, 1.927))
    back = ml.Back.rounded_rectangle(71.5, 147.5, corner)
    problem = ml.Problem(back, [lens] * 3, ml.linear_depths(500, 900, 8), cues=[ml.PairStereo()])
    found, _ = ml.solve(problem, starts=8, patience=0, proof=0).longest_baseline
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
    design = ml.solve(problem, starts=8, patience=1, proof=0)
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
    assert ml.solve(problem, starts=16, patience=2, proof=0).score <= best


def test_both_penalties_lead_to_equally_good_designs() -> None:
    by_distance, by_area = (
        ml.solve(small(), starts=16, patience=2, proof=0, penalty=penalty)
        for penalty in (ml.distance_penalty, ml.area_penalty)
    )
    assert by_area.certificate.feasible
    assert by_area.score == pytest.approx(by_distance.score, rel=1e-3)


def test_a_cue_of_ones_own_is_searched_as_well_as_one_with_a_closed_form() -> None:
    closed = small()
    general = ml.Problem(closed.back, closed.lenses, closed.depths, cues=[ml.PairStereo(), OwnDefocus()])
    one, other = (ml.solve(problem, starts=16, patience=2, proof=0) for problem in (closed, general))
    assert other.rmse == pytest.approx(one.rmse, rel=1e-3)


@pytest.mark.parametrize("start", [4.0, 9.0])
def test_a_score_may_change_its_sign_on_the_way(start: float) -> None:
    # The square of the distance to a place on the back, less 1: -1 there.
    def score(layout: ml.Layout) -> torch.Tensor:
        return (layout.position[..., 0, :] - start).square().sum(-1) - 1

    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], score)
    assert ml.solve(problem, starts=4, patience=0).score == pytest.approx(-1, abs=1e-9)


def test_the_same_seed_gives_the_same_design_to_the_bit(crowded: ml.Problem) -> None:
    one, other = (ml.solve(crowded, starts=8, patience=1, seed=4, proof=0) for _ in range(2))
    assert one.layout.position.equal(other.layout.position)
    assert one.layout.focus.equal(other.layout.focus)


def test_threads_change_nothing() -> None:
    # Large enough for torch and the linear algebra to share the work among threads, and to round otherwise, were they left to.
    lens = ml.Lens(5.0, (0.5, 2.0), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(ml.Back.rectangle(60, 40), [lens] * 8, ml.log_depths(300, 2000, 512))
    used, designs = torch.get_num_threads(), []
    try:
        for threads in (1, 2):
            torch.set_num_threads(threads)
            with threadpool_limits(threads):
                designs.append(ml.solve(problem, starts=64, patience=0, proof=0, batch=128))
            assert torch.get_num_threads() == threads
    finally:
        torch.set_num_threads(used)
    assert designs[0].layout.position.equal(designs[1].layout.position)
    assert designs[0].layout.focus.equal(designs[1].layout.focus)


def test_single_precision_finds_it_too() -> None:
    double, single = (
        ml.solve(small(), starts=16, patience=2, proof=0, dtype=dtype) for dtype in (torch.float64, torch.float32)
    )
    assert single.certificate.feasible
    assert single.rmse == pytest.approx(double.rmse, rel=0.01)


@pytest.mark.parametrize("batch", [1, 5, 100])
def test_other_batches_find_as_good_a_design(batch: int) -> None:
    problem = packing(ml.Back.rectangle(1, 1), 3, 0.5)
    # The centres of the three make an equilateral triangle of side m = 6^(1/2) - 2^(1/2), in units of the square they are in.
    apart = 6**0.5 - 2**0.5
    best = apart / (2 * (1 + apart))
    assert -ml.solve(problem, starts=8, patience=0, batch=batch).score == pytest.approx(best, abs=1e-9)


def test_a_longer_list_of_starts_begins_alike(crowded: ml.Problem) -> None:
    few, many = (ml.solve(crowded, starts=count, patience=0, proof=0, batch=8).convergence for count in (4, 12))
    # Of the first half batch of four starts both are told the same.
    torch.testing.assert_close(few.scores[:4], many.scores[:4], rtol=0, atol=0)


def test_without_patience_no_layout_is_varied(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    ml.solve(crowded, starts=4, patience=0, proof=0, listener=told.append)
    assert {progress.stage for progress in told} == {"starts", "polish"}


def test_variations_find_what_the_starts_did_not() -> None:
    # Five circles: from this start four stand in the corners and one beside them instead of amid them.
    problem = packing(ml.Back.rectangle(1, 1), 5, 0.5)
    alone, varied = (-ml.solve(problem, starts=1, patience=patience).score for patience in (0, 3))
    best = (2**0.5 - 1) / 2
    assert alone < 0.99 * best
    assert varied == pytest.approx(best, abs=1e-9)


def test_every_start_has_a_history(crowded: ml.Problem) -> None:
    convergence = ml.solve(crowded, starts=11, patience=0, proof=0, batch=4).convergence
    assert convergence.scores.shape == (11, len(convergence.steps))
    assert set(convergence.polished) <= set(range(11))


def test_locked_lenses_stay(crowded: ml.Problem) -> None:
    lenses = (replace(crowded.lenses[0], position=(24.0, 6.0)), *crowded.lenses[1:])
    problem = ml.Problem(crowded.back, lenses, crowded.depths, crowded.weights, crowded.cues, crowded.gap)
    design = ml.solve(problem, starts=8, patience=1, proof=0)
    assert design.layout.position[0].tolist() == [24.0, 6.0]
    assert design.layout.position[2, 1].item() == 25.0
    assert design.feasible


def test_a_larger_back_is_no_worse() -> None:
    scores = [
        ml.solve(small(ml.Back.rectangle(side, side)), starts=8, patience=1, proof=0).score for side in (14, 18, 22)
    ]
    assert scores == sorted(scores, reverse=True)


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
        patience=0,
    )
    assert design.status == "infeasible"
    assert design.reason.startswith("no feasible layout found: at best lens")
    # The centres can be sqrt(32) mm apart, and the lack may be shared with the outline.
    assert -design.certificate.tightest.room <= 6 - 32**0.5 + 1e-6


@pytest.mark.parametrize("limit", [0.05, 1.0])
def test_a_time_limit_gives_the_best_so_far(crowded: ml.Problem, limit: float) -> None:
    design = ml.solve(crowded, starts=64, patience=10_000, time_limit=limit, proof=0)
    assert design.status == "time limit"
    assert design.feasible


def test_a_time_limit_is_kept() -> None:
    # Two minutes of work; the first answer may be late by a second, a wave and a polish stop where they are.
    problem = small(ml.Back.rectangle(80, 60), count=12)
    began = monotonic()
    ml.solve(problem, starts=4096, patience=10_000, time_limit=1.0, proof=0)
    assert monotonic() - began < 10


def test_progress_is_told_stage_by_stage(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    ml.solve(crowded, starts=8, patience=2, batch=4, proof=0, listener=told.append)
    stages = [progress.stage for progress in told]
    assert [stage for stage, before in zip(stages, ["", *stages], strict=False) if stage != before] == [
        "starts",
        "variations",
        "polish",
    ]
    assert all(0 <= progress.done <= 1 for progress in told)
    assert told[-1].alive == 8


def test_the_best_so_far_never_gets_worse(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    design = ml.solve(crowded, starts=8, patience=2, batch=4, proof=0, listener=told.append)
    best = [progress.best for progress in told if not isnan(progress.best)]
    assert best == sorted(best, reverse=True)
    assert best[-1] == design.score


def test_every_layout_that_is_told_is_certified(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    ml.solve(crowded, starts=8, patience=2, batch=4, proof=0, listener=told.append)
    layouts = [progress.layout for progress in told if progress.layout is not None]
    assert layouts
    for layout in layouts:
        found = certify(crowded.back, crowded.lenses, crowded.focus_range, layout, crowded.gap)
        assert found.feasible


def test_what_is_told_is_the_score_of_its_layout(crowded: ml.Problem) -> None:
    told: list[Progress] = []
    ml.solve(crowded, starts=8, patience=0, proof=0, listener=told.append)
    for progress in told:
        if progress.layout is not None:
            assert crowded.score_over_depths(progress.layout).item() == pytest.approx(progress.best, rel=1e-9)


def test_no_healthy_start_is_an_error() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], lambda layout: (-layout.aperture_radius[..., 0]).sqrt()
    )
    with pytest.raises(RuntimeError, match="none of the 4 starts stayed healthy"):
        ml.solve(problem, starts=4, patience=1)


def test_healthy_starts_decide_where_others_are_not() -> None:
    # No number on the right half of the back; on the left, the farther left the better.
    def score(layout: ml.Layout) -> torch.Tensor:
        x = layout.position[..., 0, 0]
        return torch.where(x > 5, torch.nan, x)

    told: list[Progress] = []
    problem = ml.ScoreProblem(ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 0.5))], score)
    design = ml.solve(problem, starts=16, patience=1, listener=told.append)
    assert design.score == pytest.approx(0.5, abs=1e-8)
    assert 4 <= told[-1].alive <= 12


@pytest.mark.parametrize(
    ("name", "number"),
    [
        ("starts", 0),
        ("starts", -1),
        ("patience", -1),
        ("proof", -1),
        ("batch", 0),
        ("time_limit", 0.0),
        ("time_limit", float("nan")),
    ],
)
def test_numbers_out_of_range_are_refused_by_name(crowded: ml.Problem, name: str, number: float) -> None:
    with pytest.raises(ValueError, match=f"{name} must be >"):
        ml.solve(crowded, **{name: number})


def test_the_design_knows_a_bound_below_it() -> None:
    design = ml.solve(small(), starts=8, patience=0, proof=50)
    assert design.bound is not None
    assert design.bound.value is not None
    assert 0 < design.bound.value <= design.score


def anywhere(problem: ml.Problem, seed: int) -> ml.Layout:
    """A layout whose every unknown is drawn at random, whether it is feasible or not."""
    variables = Variables(problem)
    draws = torch.rand(len(variables), generator=torch.Generator().manual_seed(seed), dtype=torch.float64)
    return variables.layout(draws * variables.upper)


@settings(max_examples=8)
@given(st.integers(0, 10**6))
def test_no_design_is_worse_than_a_feasible_layout_that_was_known(seed: int) -> None:
    problem = small(ml.Back.rectangle(40, 30))
    layout, certificate = legalise(problem, tighten(Limits(problem), anywhere(problem, seed)))
    assume(certificate.feasible)
    design = ml.solve(problem, starts=0, patience=0, proof=0, known=[layout])
    assert design.score <= problem.score_over_depths(layout).item() * (1 + 1e-12)


@settings(max_examples=4)
@given(st.integers(0, 10**6))
def test_a_known_layout_that_breaks_constraints_is_brought_near(seed: int) -> None:
    problem = small(ml.Back.rectangle(40, 30))
    outside = anywhere(problem, seed)
    beyond = ml.Layout(outside.position + 10, outside.aperture_radius + 1, outside.focus * 2)
    assert ml.solve(problem, starts=0, patience=0, proof=0, known=[beyond]).feasible


def test_a_known_optimum_is_the_design_without_any_start() -> None:
    # By stereo alone: both lenses in opposite corners, as narrow as they may be.
    lens = ml.Lens(1.0, (1.0, 2.0))
    problem = ml.Problem(ml.Back.rectangle(30, 40), [lens] * 2, [500.0], cues=[ml.PairStereo()])
    best = ml.Layout([[1.0, 1.0], [29.0, 39.0]], [1.0, 1.0], [500.0, 500.0])
    design = ml.solve(problem, starts=0, patience=0, proof=0, known=[best])
    assert design.longest_baseline[0] == hypot(28, 38)
    assert design.origin.known == 1


def robust(problem: ml.Problem) -> ml.Robust:
    return ml.Robust(problem, ml.Disturbance(shift=0.05), samples=4)


@pytest.mark.parametrize(
    "question",
    [
        small(),
        replace(small(), cues=(ml.LimitedStereo(ml.PairLimits()), ml.LensDefocus())),
        replace(small(), fusion=ml.InverseVariance()),
        replace(small(), metric=ml.WorstCase()),
        robust(small()),
        packing(ml.Back.rectangle(10, 10), 3, 5.0),
    ],
    ids=["thesis", "limited", "fusion", "worst case", "robust", "score of one's own"],
)
def test_any_question_begins_from_what_is_known(question: ml.Problem | ml.Robust | ml.ScoreProblem) -> None:
    found = ml.solve(question, starts=1, patience=0, proof=0)
    again = ml.solve(question, starts=0, patience=0, proof=0, known=[found.layout])
    assert again.score <= found.score
    assert again.convergence is None


def test_what_is_known_is_begun_from_besides_the_starts(crowded: ml.Problem) -> None:
    without = ml.solve(crowded, starts=4, patience=0, proof=0)
    besides = ml.solve(crowded, starts=4, patience=0, proof=0, known=[without.layout])
    assert besides.score <= without.score
    torch.testing.assert_close(besides.convergence.scores[:, 0], without.convergence.scores[:, 0], rtol=0.5, atol=0)
    assert len(besides.convergence.scores) == 4


def test_what_is_known_is_varied() -> None:
    # Five circles, one beside the four in the corners instead of amid them: a local optimum that only a variation leaves.
    problem = packing(ml.Back.rectangle(1, 1), 5, 0.5)
    stuck = ml.solve(problem, starts=1, patience=0)
    assert -stuck.score < 0.99 * (2**0.5 - 1) / 2
    found = ml.solve(problem, starts=0, patience=3, known=[stuck.layout])
    assert -found.score == pytest.approx((2**0.5 - 1) / 2, abs=1e-9)


def test_the_same_known_layouts_give_the_same_design_to_the_bit(crowded: ml.Problem) -> None:
    known = [ml.solve(crowded, starts=1, patience=0, proof=0, seed=seed).layout for seed in (0, 1)]
    one, other = (ml.solve(crowded, starts=0, patience=1, proof=0, known=known) for _ in range(2))
    assert one.to_json() == other.to_json()


@pytest.mark.parametrize("count", [2, 4])
def test_a_known_layout_of_other_lenses_is_refused(crowded: ml.Problem, count: int) -> None:
    layout = ml.Layout([[5.0, 5.0]] * count, [1.0] * count, [[500.0, 600.0]] * count)
    with pytest.raises(ValueError, match=r"known\[0\] must be one layout, its foci of shape \[3, 2\], got "):
        ml.solve(crowded, known=[layout])


def test_known_layouts_without_a_score_are_an_error() -> None:
    problem = ml.ScoreProblem(
        ml.Back.rectangle(10, 10), [ml.Lens(1.0, (0.5, 1.0))], lambda layout: (-layout.aperture_radius[..., 0]).sqrt()
    )
    with pytest.raises(RuntimeError, match="none of the 1 starts stayed healthy"):
        ml.solve(problem, starts=0, known=[ml.Layout([[5.0, 5.0]], [0.5], [1.0])])
