from dataclasses import replace

from multilens.bounds.bound import Bound
from multilens.layout import Layout
from multilens.problem import Problem
from multilens.report.tables import (
    band_table,
    bound_in_words,
    clearance_table,
    lens_table,
    origin_table,
    proof_in_words,
    range_table,
    sensitivity_table,
)
from multilens.score_problem import ScoreProblem
from multilens.search.evaluate import as_given


def test_a_lens_is_told_with_all_its_foci(design):
    table = lens_table(design.problem, design.layout)
    assert table.head[0] == "lens"
    assert table.rows[1] == ("2", "50.000", "80.000", "1.500", "2.29", "6.86", "5.500", "900.0, 4500.0")


def test_names_stand_beside_the_numbers_of_lenses(design):
    lenses = [replace(lens, name=f"camera {i}") for i, lens in enumerate(design.problem.lenses, 1)]
    table = lens_table(Problem(design.problem.back, lenses, design.problem.depths), design.layout)
    assert table.head[:3] == ("lens", "name", "x (mm)")
    assert [row[:2] for row in table.rows[:2]] == [("1", "camera 1"), ("2", "camera 2")]
    assert {len(row) for row in table.rows} == {len(table.head)}


def test_without_depths_there_is_nothing_to_focus_on(design):
    question = ScoreProblem(design.problem.back, design.problem.lenses, lambda layout: layout.aperture_radius.sum(-1))
    table = lens_table(question, design.layout)
    assert len(table.rows[0]) == len(table.head) == 7


def test_bands_touch_from_the_nearest_depth_to_the_farthest(design):
    rows = band_table(design.problem, design.layout).rows
    assert (rows[0][0], rows[-1][1]) == ("0.2000", "5.000")
    assert [row[1] for row in rows[:-1]] == [row[0] for row in rows[1:]]
    assert {row[3] for row in rows if row[2] == "stereo 1-2"} == {"83.35"}


def test_the_tightest_constraint_is_told_first_and_none_is_left_out(design):
    rows = clearance_table(design).rows
    assert len(rows) == len(design.certificate.clearances)
    assert rows[0][0] == design.certificate.tightest.what
    assert {row[2] for row in rows} == {"kept"}


def test_the_proof_says_how_many_constraints_are_kept_or_broken(design):
    assert proof_in_words(design).endswith(f"All {len(design.certificate.clearances)} are kept, at tolerance 0.")
    tight = as_given(design.problem, Layout([[8, 8], [9, 9], [10, 60]], [1.0] * 3, [[900, 900]] * 3))
    assert proof_in_words(tight).endswith(f"1 of {len(tight.certificate.clearances)} are broken.")
    assert clearance_table(tight).rows[0] == ("lens 1 to lens 2", "-8.586", "broken")


def test_the_bound_is_told_with_its_gap_or_with_why_there_is_none(design):
    assert "gap 10 % of the score" in bound_in_words(design)
    assert bound_in_words(replace(design, bound=Bound(None, "nobody knows one"))) == "No lower bound: nobody knows one."
    assert bound_in_words(replace(design, bound=None)) == "No lower bound was sought."


def test_sensitivities_are_those_of_the_design(design):
    found = design.sensitivity()
    rows = sensitivity_table(found).rows
    assert [float(row[4]) for row in rows] == [float(f"{lens.covered:.3g}") for lens in found.lenses]
    assert all(row[1].endswith("*") == lens.shift.kink for row, lens in zip(rows, found.lenses, strict=True))


def test_the_working_range_is_that_of_the_tolerance(design):
    found = design.working_range(design.tolerance)
    table = range_table(found)
    assert [tuple(map(float, row)) for row in table.rows] == [
        (float(f"{near:.5g}"), float(f"{far:.5g}")) for near, far in found.intervals
    ]
    assert f"{100 * found.share:.3g} %" in table.caption


def test_what_made_a_design_is_told_whole(design):
    told = dict(origin_table(design.origin).rows)
    assert (told["seed"], told["starts"], told["commit"]) == ("7", "32", "0123abc+")
    assert told["torch"] == design.origin.versions["torch"]
