from benchmark.problems import CASES, blob, fingerprint, main_lens
from multilens.records import problem_record, read_problem


def test_names_are_unlike() -> None:
    assert len({case.name for case in CASES}) == len(CASES) >= 14


def test_there_are_problems_of_every_number_of_lenses() -> None:
    assert {len(case.problem.lenses) for case in CASES} == {2, 3, 4, 6, 8, 12}


def test_a_back_that_is_marked_convex_is_its_own_hull_without_keep_outs() -> None:
    for case in CASES:
        back = case.problem.back
        outline = back.outline.polygon()
        assert case.convex == (not back.keep_outs and outline.area > outline.convex_hull.area * (1 - 1e-9)), case.name


def test_the_blob_has_200_corners() -> None:
    assert len(blob().outline.segments) == 200


def test_a_problem_read_back_from_its_record_has_the_same_fingerprint() -> None:
    for case in CASES:
        assert fingerprint(read_problem(problem_record(case.problem), "problem")) == fingerprint(case.problem)


def test_a_change_of_one_lens_changes_the_fingerprint() -> None:
    import multilens as ml

    one, other = (
        ml.Problem(ml.Back.rectangle(70, 150), [main_lens(clearance)], ml.log_depths(200, 5000, 8))
        for clearance in (6.17, 6.18)
    )
    assert fingerprint(one) != fingerprint(other)
