import numpy as np
import pytest
from matplotlib.figure import Figure

from multilens.plot.style import style
from multilens.plot.sweep_count import count_figure, draw_error_by_count, percent
from multilens.plot.sweep_groups import questions
from multilens.plot.sweep_lines import colours, lines

ERRORS = {"1": 21.0, "2": 1.4, "3": 1.3, "4": 1.35}


def by_count(settings):
    return ERRORS[settings["lenses.count"]] * (1 if settings.get("back", "a") == "a" else 3)


@pytest.fixture
def axes(swept):
    rows = swept({"back": ["a", "b"], "lenses.count": list(ERRORS)}, by_count)
    with style():
        ax = Figure(figsize=(5, 4)).add_axes((0.15, 0.15, 0.8, 0.8))
        found = lines(questions(rows)[0], rows)
        assert draw_error_by_count(ax, "RMSE (mm)", found, colours(found)) == 0
    return ax


def curves(ax, marker):
    return [line.get_xydata() for line in ax.lines if line.get_marker() == marker and len(line.get_xdata())]


def test_a_curve_goes_through_the_errors_of_the_rows(axes):
    expected = np.array([[int(count), error] for count, error in ERRORS.items()])
    first, second = curves(axes, "o")
    assert np.allclose(first, expected)
    assert np.allclose(second, expected * [1, 3])


def test_the_bound_is_below_the_curve(axes):
    for found, bound in zip(curves(axes, "o"), curves(axes, "_"), strict=True):
        assert np.allclose(bound[:, 1], found[:, 1] * 0.9**0.5)


def test_every_step_is_labelled_with_its_gain(axes):
    told = sorted(text.get_text() for text in axes.texts)
    assert told == sorted(2 * ["\N{MINUS SIGN}93 %", "\N{MINUS SIGN}7.1 %", "+3.8 %"])


def test_a_number_of_lenses_without_a_design_has_a_cross(swept):
    rows = swept({"lenses.count": ["1", "2", "9"]}, lambda s: "infeasible" if s["lenses.count"] == "9" else 1.0)
    figure = count_figure(rows)
    assert [list(mark[:, 0]) for mark in curves(figure.axes[0], "x")] == [[9]]
    assert "without a design: job 2 (infeasible)" in [text.get_text() for text in figure.texts]


def test_a_setting_that_found_nothing_at_all_has_crosses_and_a_name(swept, clear):
    keys = {"lenses.count": ["1", "2"], "lenses.lens.clearance": ["4", "30"]}
    rows = swept(keys, lambda s: "infeasible" if s["lenses.lens.clearance"] == "30" else 1.0)
    with style():
        figure = count_figure(rows)
    assert [list(mark[:, 0]) for mark in curves(figure.axes[0], "x")] == [[1, 2]]
    assert "clearance 30" in [text.get_text() for text in figure.legends[0].get_texts()]
    clear(figure)


def test_there_is_a_panel_for_everything_that_was_asked(swept, clear):
    units = {"mean_square": ("RMSE", "mm"), "relative": ("relative RMSE", "%")}
    rows = swept({"metric": list(units), "lenses.count": list(ERRORS)}, by_count, lambda s: units[s["metric"]])
    figure = count_figure(rows)
    assert [ax.get_ylabel() for ax in figure.axes] == ["RMSE (mm)", "relative RMSE (%)"]
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["metric mean_square", "metric relative"]
    clear(figure)


def test_without_bounds_there_is_no_word_of_them(swept):
    figure = count_figure(swept({"lenses.count": ["1", "2"]}, by_count, bound=None))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["found"]


@pytest.mark.parametrize("counts", [["3"], ["3", "9"]])
def test_there_is_no_picture_where_designs_have_one_number_of_lenses(swept, counts):
    assert (
        count_figure(swept({"lenses.count": counts}, lambda s: 1.0 if s["lenses.count"] == "3" else "failed")) is None
    )


def test_labels_of_many_lines_keep_apart_and_what_is_left_out_is_told(swept, clear):
    keys = {"search.seed": [str(k) for k in range(20)], "depth": ["a", "b"], "lenses.count": list(ERRORS)}
    with style():
        figure = count_figure(swept(keys, lambda s: by_count(s) * (1 + 0.01 * int(s["search.seed"]))))
    clear(figure)
    assert "12 more, not as good" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert any(text.get_text().startswith("left out: ") for text in figure.texts)


def test_errors_of_zero_are_drawn_on_a_linear_axis(swept):
    figure = count_figure(swept({"lenses.count": ["1", "2"]}, lambda s: 0.0))
    assert figure.axes[0].get_yscale() == "linear"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (-0.2749, "\N{MINUS SIGN}27 %"),
        (0.0071, "+0.71 %"),
        (-0.0512, "\N{MINUS SIGN}5.1 %"),
        (1.2, "+120 %"),
        (9e-5, "0 %"),
    ],
)
def test_a_change_is_told_to_two_digits(change, told):
    assert percent(change) == told
