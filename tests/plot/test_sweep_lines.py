import pytest

from multilens.plot.sweep_groups import questions
from multilens.plot.sweep_lines import MOST_LINES, colours, lines
from multilens.sweep_row import SweepRow


def test_there_is_a_line_for_each_setting_of_all_else(swept):
    rows = swept(
        {"depth": ["near"], "back": ["a", "b"], "search.seed": ["0", "1"], "lenses.count": ["1", "2"]}, lambda _: 1.0
    )
    found = lines(questions(rows)[0], rows)
    assert [dict(line.name) for line in found] == [
        {"back": back, "search.seed": seed} for back in ("a", "b") for seed in ("0", "1")
    ]


def test_points_bounds_and_gains_are_those_of_the_rows(swept):
    error = {"1": 8.0, "2": 4.0, "4": 5.0}
    rows = swept({"lenses.count": list(error)}, lambda settings: error[settings["lenses.count"]], bound=0.25)
    (line,) = lines(questions(rows)[0], rows)
    assert line.points == [(1, 8), (2, 4), (4, 5)]
    assert line.bounds == [(1, 4), (2, 2), (4, 2.5)]
    assert [change for *_, change in line.gains] == [pytest.approx(-0.5), pytest.approx(0.25)]
    assert [x for x, *_ in line.gains] == [1.5, 3]


def test_of_several_rows_with_as_many_lenses_the_best_counts():
    rows = [
        SweepRow(
            job, (("lenses", name),), "complete", lens_count=count, metric="RMSE", unit="mm", figure=figure, score=1
        )
        for job, (name, count, figure) in enumerate([("a", 2, 3.0), ("b", 2, 2.0), ("c", 3, 1.0)])
    ]
    (line,) = lines(questions(rows)[0], rows)
    assert line.points == [(2, 2), (3, 1)]


def test_numbers_of_lenses_without_a_design_are_kept(swept):
    rows = swept(
        {"lenses.count": ["1", "2", "9"]}, lambda settings: "infeasible" if settings["lenses.count"] == "9" else 1.0
    )
    (line,) = lines(questions(rows)[0], rows)
    assert line.failed == [9]


def test_the_best_of_many_lines_have_colours_of_their_own(swept):
    seeds = [str(seed) for seed in range(MOST_LINES + 3)]
    rows = swept(
        {"search.seed": seeds, "lenses.count": ["1", "2"]}, lambda settings: 20.0 - int(settings["search.seed"])
    )
    chosen = colours(lines(questions(rows)[0], rows))
    assert [dict(name)["search.seed"] for name in chosen] == seeds[3:]
    assert len(set(chosen.values())) == MOST_LINES
