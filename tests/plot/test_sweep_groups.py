from math import sqrt

import pytest

from multilens.plot.sweep_groups import (
    bound_figure,
    grouped,
    in_words,
    questions,
    short_names,
    shortened,
    varied,
    without_design,
)
from multilens.sweep_row import SweepRow


def test_a_key_of_one_value_does_not_vary(swept):
    rows = swept({"experiment": ["demo"], "lenses.count": ["1", "2"]}, lambda settings: 1.0)
    assert list(varied(rows)) == ["lenses.count"]


def test_numbers_are_ordered_by_size_and_words_as_they_come(swept):
    rows = swept({"back.outline.width": ["9", "10", "-1e1"], "depth": ["room", "near"]}, lambda settings: 1.0)
    assert varied(rows) == {"back.outline.width": ("-1e1", "9", "10"), "depth": ("room", "near")}


def test_groups_share_every_row_once_in_the_order_of_their_values(swept):
    rows = swept({"lenses.count": ["10", "9"], "depth": ["room", "near"]}, lambda settings: 1.0)
    groups = grouped(rows, ["lenses.count"])
    assert [group.settings for group in groups] == [(("lenses.count", "9"),), (("lenses.count", "10"),)]
    assert sorted(row.job for group in groups for row in group.rows) == [row.job for row in rows]


def test_a_row_without_settings_is_in_no_group():
    damaged = SweepRow(0, (), "unreadable", "truncated")
    assert grouped([damaged], ["depth"]) == ()


def test_errors_at_other_depths_are_no_match(swept):
    rows = swept({"depth": ["near", "far"], "back": ["a", "b"]}, lambda settings: 1.0)
    assert [[row.job for row in group.rows] for group in questions(rows)] == [[0, 1], [2, 3]]


def test_unlike_units_never_share_a_group(swept):
    rows = swept(
        {"lenses.count": ["1", "2"], "lenses.lens.clearance": ["1", "2"]},
        lambda settings: 1.0 if settings != {"lenses.count": "2", "lenses.lens.clearance": "2"} else "failed",
        lambda settings: ("RMSE", "mm") if settings["lenses.count"] == "1" else ("RMSE", "%"),
    )
    groups = questions(rows)
    assert [group.quantity for group in groups] == ["RMSE (mm)", "RMSE (%)"]
    assert [[row.job for row in group.rows] for group in groups] == [[0, 1, 3], [2]]


def test_what_nothing_was_found_for_has_no_group(swept):
    rows = swept({"depth": ["near", "far"]}, lambda settings: 1.0 if settings["depth"] == "near" else "infeasible")
    assert [group.settings for group in questions(rows)] == [(("depth", "near"),)]


def test_a_bound_is_told_as_its_metric_quotes_it():
    row = SweepRow(0, (), "complete", metric="relative", figure=100 * sqrt(0.04), score=0.04, unit="%", bound=0.01)
    assert bound_figure(row) == pytest.approx(10.0)


@pytest.mark.parametrize(("score", "bound"), [(4.0, None), (4.0, -1.0), (0.0, 0.0)])
def test_a_bound_that_is_not_known_has_no_figure(score, bound):
    assert bound_figure(SweepRow(0, (), "complete", metric="RMSE", figure=2.0, score=score, bound=bound)) is None


def test_a_score_of_ones_own_is_quoted_as_it_is():
    assert bound_figure(SweepRow(0, (), "complete", figure=5.0, score=5.0, bound=4.0)) == 4.0


def test_names_are_as_short_as_they_can_be_told_apart():
    keys = ("lenses.count", "depth.count", "back", "+back.keep_outs", "a.b", "b")
    assert list(short_names(keys).values()) == ["lenses.count", "depth.count", "back", "keep_outs", "a.b", "b"]


@pytest.mark.parametrize("words", ["", "short", "iphone_15_pro_max_island_of_my_own"])
@pytest.mark.parametrize("longest", [4, 5, 24])
def test_shortened_words_keep_their_ends(words, longest):
    told = shortened(words, longest)
    assert len(told) <= longest
    assert told == words or (told[0], told[-1]) == (words[0], words[-1])


def test_settings_are_said_by_short_names():
    settings = (("lenses.count", "3"), ("depth", "room"))
    assert in_words(settings, {"lenses.count": "count", "depth": "depth"}) == "count 3, depth room"


def test_an_index_does_not_stand_alone():
    keys = ("lenses.lens.f_number.0", "lenses.count", "lenses.places.3.0")
    assert list(short_names(keys).values()) == ["f_number.0", "count", "places.3.0"]


def test_few_jobs_without_a_design_are_named_and_many_counted():
    found = [SweepRow(0, (), "complete", figure=1.0)]
    few = [SweepRow(job, (), "infeasible") for job in (3, 8)]
    many = [SweepRow(job, (), "failed" if job % 2 else "infeasible") for job in range(10, 20)]
    assert without_design(found) == ""
    assert without_design(found + few) == "without a design: job 3 (infeasible), job 8 (infeasible)"
    assert without_design(found + many) == "without a design: 10 of 11 jobs (5 infeasible, 5 failed)"
