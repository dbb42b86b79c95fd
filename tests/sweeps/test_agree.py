"""Jobs of a sweep that begin from their neighbours' layouts."""

import pickle
from dataclasses import replace
from itertools import product

import jaxtyping
import pytest
import torch

import multilens as ml
from multilens.search.evaluate import as_given
from multilens.search.neighbours import MOST_PLACES
from multilens.sweeps.agree import agree, neighbours, unlike_neighbours, why_worse


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def asked(count: int, width: float = 40.0, height: float = 30.0, widest: float = 2.0) -> ml.Problem:
    lens = ml.Lens(5.0, (0.5, widest), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)
    return ml.Problem(ml.Back.rectangle(width, height), [lens] * count, ml.log_depths(300, 2000, 32))


def weakly(problem: ml.Problem, seed: int = 0) -> ml.Design:
    return ml.solve(problem, starts=1, patience=0, proof=0, seed=seed)


def out_of_focus(design: ml.Design) -> ml.Design:
    """The same layout with all foci as near as may be, as a search may leave it."""
    near = torch.tensor([near for near, _ in design.problem.focus_range]).double().unsqueeze(-1)
    layout = ml.Layout(design.layout.position, design.layout.aperture_radius, near.expand_as(design.layout.focus))
    return replace(design, layout=layout)


def poor(problem: ml.Problem) -> ml.Design:
    """A layout that nobody would choose: lenses close together, all focused alike."""
    count = len(problem.lenses)
    places = [[2.5 + 4.2 * index, 2.5] for index in range(count)]
    return as_given(problem, ml.Layout(places, [0.5] * count, [1999.0] * count))


def crossed(*columns: tuple[str, list]) -> dict[int, tuple[tuple[str, str], ...]]:
    """Settings of the jobs of a sweep, numbered as Hydra does: the last key changes first."""
    keys, values = zip(*columns, strict=True)
    return {job: tuple(zip(keys, map(str, row), strict=True)) for job, row in enumerate(product(*values))}


def test_neighbours_differ_in_one_key_by_values_next_to_each_other() -> None:
    settings = crossed(("a", [1, 2, 3]), ("b", ["x", "y", "z"]))
    told = neighbours(settings)
    for job, other in product(settings, repeat=2):
        apart = abs(job // 3 - other // 3) + abs(job % 3 - other % 3)
        assert (other in told[job]) == (apart == 1)


def test_numbers_are_next_to_each_other_by_their_size_however_they_are_listed() -> None:
    assert neighbours(crossed(("lenses.count", [10, 1, 2]))) == {0: [2], 1: [2], 2: [1, 0]}


def test_more_is_never_worse_at_the_end_of_a_sweep_of_weak_searches() -> None:
    counts, widths = [1, 2, 3, 4], [30.0, 40.0]
    settings = crossed(("lenses.count", counts), ("back.outline.width", widths))
    own = {job: weakly(asked(*row), seed=job) for job, row in enumerate(product(counts, widths))}
    score = {
        key: design.score for key, design in zip(product(counts, widths), agree(own, settings).values(), strict=True)
    }
    for (count, width), found in score.items():
        assert score.get((count + 1, width), 0.0) <= found * (1 + 2e-6)
        assert score.get((count, width + 10), 0.0) <= found * (1 + 2e-6)


def test_a_good_layout_reaches_the_far_end_of_a_sweep() -> None:
    widths = [30.0, 32.0, 34.0, 36.0]
    own = {job: poor(asked(2, width)) for job, width in enumerate(widths)}
    own[3] = ml.solve(asked(2, 36.0), starts=16, patience=1, proof=0)
    found = agree(own, crossed(("width", widths)))
    for job, width in enumerate(widths):
        best = ml.solve(asked(2, width), starts=16, patience=1, proof=0)
        assert found[job].score == pytest.approx(best.score, rel=1e-4)


def test_no_job_becomes_worse_than_its_own_search_left_it() -> None:
    widest = [0.8, 1.2, 2.0]
    own = {job: weakly(asked(3, widest=most), seed=job) for job, most in enumerate(widest)}
    found = agree(own, crossed(("aperture", widest)))
    assert all(found[job].score <= own[job].score for job in own)
    assert all(found[job].feasible for job in own)


def test_the_order_in_which_jobs_were_computed_changes_nothing() -> None:
    counts = [1, 2, 3]
    own = {job: weakly(asked(count)) for job, count in enumerate(counts)}
    settings = crossed(("lenses.count", counts))
    one, other = agree(own, settings), agree(dict(reversed(own.items())), dict(reversed(settings.items())))
    assert [one[job].to_json() for job in own] == [other[job].to_json() for job in own]


def test_whoever_computes_changes_nothing() -> None:
    own = {job: poor(asked(count)) for job, count in enumerate([2, 3])}
    settings = crossed(("lenses.count", [2, 3]))

    def elsewhere(function, tasks):
        return [pickle.loads(pickle.dumps(function(*pickle.loads(pickle.dumps(task))))) for task in tasks]

    here, there = agree(own, settings), agree(own, settings, compute=elsewhere)
    assert here[0] is not own[0]
    assert [here[job].to_json() for job in own] == [there[job].to_json() for job in own]


def test_jobs_that_were_asked_the_same_are_compared_and_left_alone() -> None:
    own = {0: poor(asked(3)), 1: weakly(asked(3))}
    settings = crossed(("search.seed", [0, 1]))
    assert unlike_neighbours(own, settings) == {0: [], 1: []}
    assert agree(own, settings)[0] is own[0]


def test_names_of_lenses_make_no_other_question() -> None:
    own = {}
    for job, name in enumerate(("main", "tele")):
        design = poor(asked(2))
        lenses = [replace(lens, name=name) for lens in design.problem.lenses]
        own[job] = replace(design, problem=ml.Problem(design.problem.back, lenses, design.problem.depths))
    assert unlike_neighbours(own, crossed(("lenses.lens.name", ["main", "tele"]))) == {0: [], 1: []}


def test_a_job_that_found_nothing_stands_between_others() -> None:
    own = {0: poor(asked(2)), 2: poor(asked(2, 50.0))}
    found = agree(own, crossed(("width", [40, 45, 50])))
    assert found[0] is own[0]


def test_a_design_that_became_better_keeps_its_status_and_tells_how_many_layouts_it_began_from() -> None:
    own = {0: ml.solve(asked(2), starts=8, patience=0, proof=10), 1: out_of_focus(weakly(asked(3)))}
    found = agree(own, crossed(("lenses.count", [2, 3])))[1]
    assert found.score < own[1].score
    assert (found.status, found.bound) == (own[1].status, own[1].bound)
    assert found.origin == replace(own[1].origin, known=MOST_PLACES)


@pytest.mark.parametrize(
    "made",
    [
        lambda n: ml.Problem(asked(n).back, asked(n).lenses, asked(n).depths, fusion=ml.InverseVariance()),
        lambda n: ml.Problem(
            asked(n).back, asked(n).lenses, asked(n).depths, cues=[ml.LimitedStereo(ml.PairLimits()), ml.LensDefocus()]
        ),
        lambda n: ml.Problem(asked(n).back, asked(n).lenses, asked(n).depths, metric=ml.WorstCase()),
        lambda n: ml.Robust(asked(n), ml.Disturbance(shift=0.05), samples=4),
        lambda n: ml.ScoreProblem(ml.Back.rectangle(40, 30), asked(n).lenses, lambda at: -at.aperture_radius.sum(-1)),
    ],
    ids=["fusion", "limited", "worst case", "robust", "score of one's own"],
)
def test_any_question_agrees(made) -> None:
    questions = [made(2), made(3)]
    own = {job: weakly(question) for job, question in enumerate(questions)}
    found = agree(own, crossed(("lenses.count", [2, 3])))
    assert all(found[job].score <= own[job].score for job in own)


def strip(width: float, places: list[float], radius: float) -> ml.Design:
    """Lenses in a row on a strip that is as high as their bodies at a radius of 1 mm."""
    lens = ml.Lens(5.0, (0.5, 1.0), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)
    problem = ml.Problem(ml.Back.rectangle(width, 5.0), [lens] * len(places), [500.0], cues=[ml.PairStereo()])
    count = len(places)
    return as_given(problem, ml.Layout([[x, 2.5] for x in places], [radius] * count, [500.0] * count))


def test_where_another_body_costs_room_a_worse_job_says_so() -> None:
    # Between two bodies 2.5 mm wide at the ends are 3.5 mm: enough for none of 4 mm, unless the two give way.
    few, many = strip(13.5, [2.5, 11.0], 1.0), strip(13.5, [2.5, 6.5, 10.5], 0.5)
    assert why_worse(many, {4: few}) == (
        "worse than job 4 with fewer lenses: another body takes room that its lenses need"
    )


def test_where_there_is_no_room_at_all_a_worse_job_says_so() -> None:
    # Three gaps of 1.9 mm and less beside two bodies as small as they may be. Three in a heap are worse still.
    few, many = strip(12.2, [3.9, 8.4], 0.5), strip(12.2, [2.1, 4.0, 6.1], 0.5)
    assert why_worse(many, {7: few}) == (
        "worse than job 7 with fewer lenses: beside its lenses there is no room for another body"
    )


def test_a_job_that_was_asked_more_than_other_lenses_says_nothing() -> None:
    few, many = strip(13.5, [2.5, 11.0], 1.0), strip(13.5, [2.5, 6.5, 10.5], 0.5)
    nearer = replace(few.problem, depths=torch.tensor([450.0], dtype=torch.float64))
    assert why_worse(many, {4: as_given(nearer, few.layout)}) == ""


def test_a_job_that_is_no_worse_says_nothing() -> None:
    few, many = weakly(asked(2)), ml.solve(asked(3), starts=8, patience=0, proof=0)
    assert many.score < few.score
    assert why_worse(many, {0: few}) == ""
    assert why_worse(few, {1: many}) == ""
