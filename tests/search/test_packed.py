from math import inf
from time import monotonic

import pytest
import torch

import multilens as ml
from multilens.search.foci import Foci
from multilens.search.limits import Limits
from multilens.search.packed import packed
from multilens.search.polish import OutOfTimeError
from multilens.search.starts import tried_places
from multilens.search.variables import Variables

EYE = ml.Lens(1.0, (1.0, 24.0))


def found(problem: ml.Problem, begun: ml.Layout | None = None, deadline: float = inf) -> list[tuple[ml.Layout, bool]]:
    variables, generator = Variables(problem), torch.Generator().manual_seed(0)
    foci, places = Foci(problem, variables, generator), tried_places(problem.back, 0)
    nothing = torch.empty(0, len(variables.low), dtype=torch.float64)
    first = nothing if begun is None else variables.spread(variables.vector(begun)).unsqueeze(0)
    each = packed(problem, variables, foci, places, first, generator, deadline)
    return [(variables.layout_of(share), worth_a_polish) for share, worth_a_polish in each]


def eyes(count: int) -> ml.Problem:
    return ml.Problem(ml.Back.disc(25), [EYE] * count, ml.linear_depths(20, 50, 64))


@pytest.mark.parametrize("count", [2, 3])
def test_they_come_near_what_a_search_without_them_finds(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = eyes(count)
    best = min(problem.score(layout).item() for layout, _ in found(problem))
    monkeypatch.setattr("multilens.search.solve.first_layouts", lambda *_: iter(()))
    # They are not polished over single depths yet.
    assert best < 1.01 * ml.solve(problem, starts=16, patience=2, proof=0).score


def test_what_comes_unordered_is_better_than_all_before() -> None:
    problem, best = eyes(3), inf
    for layout, worth_a_polish in found(problem):
        score = problem.score(layout).item()
        assert worth_a_polish or score < best
        best = min(best, score)


def test_they_are_feasible() -> None:
    problem = eyes(4)
    for layout, _ in found(problem):
        assert Limits(problem)(layout).least > -1e-9


def test_what_is_begun_with_competes() -> None:
    problem = eyes(2)
    best = ml.solve(problem, starts=16, patience=4, proof=0)
    first, _ = found(problem, best.layout)[0]
    torch.testing.assert_close(problem.score(first).item(), best.score, rtol=1e-2, atol=0)


def test_without_defocus_stereo_is_all_they_look_at() -> None:
    problem = ml.Problem(ml.Back.disc(25), [EYE] * 2, ml.linear_depths(20, 50, 16), cues=[ml.PairStereo()])
    best, _ = min(found(problem), key=lambda each: problem.score(each[0]).item())
    # Both lenses at their smallest, at opposite ends of the disc.
    assert (best.position[0] - best.position[1]).norm().item() == pytest.approx(48, rel=1e-3)


def test_what_stands_where_another_stood_is_polished_once(monkeypatch: pytest.MonkeyPatch) -> None:
    same, polished = ml.Layout([[(-12.0, 0.0), (12.0, 0.0)]], [[11.0, 11.0]], [[30.0, 40.0]]), []
    monkeypatch.setattr("multilens.search.packed.packings", lambda *_: same)
    monkeypatch.setattr("multilens.search.packed.polish", lambda *given, **_: polished.append(given) or given[2])
    found(eyes(2))
    assert len(polished) == 1


def test_a_wide_lens_leaves_the_narrow_end_to_another(monkeypatch: pytest.MonkeyPatch) -> None:
    back = ml.Back(ml.polygon([(0, 0), (60, 0), (60, 20), (25, 20), (25, 10), (0, 10)]))
    problem = ml.Problem(back, [ml.Lens(1.0, (1.0, 5.0)), ml.Lens(1.0, (1.0, 20.0))], ml.linear_depths(20, 50, 64))
    wrong = ml.Layout([[(50.0, 10.0), (5.0, 5.0)]], [[5.0, 5.0]], [[30.0, 40.0]])
    monkeypatch.setattr("multilens.search.packed.packings", lambda *_: wrong)
    best, _ = min(found(problem), key=lambda each: problem.score(each[0]).item())
    assert best.aperture_radius.tolist() == pytest.approx([5, 10], rel=0.05)


def test_they_keep_the_deadline() -> None:
    with pytest.raises(OutOfTimeError):
        found(eyes(2), deadline=monotonic() - 1)
