from math import nan

import numpy as np
import torch
from matplotlib.figure import Figure

from multilens.convergence import Convergence
from multilens.metrics import MeanSquare, Relative
from multilens.plot.convergence import BEST, START, draw_convergence
from multilens.plot.style import style

MEAN_SQUARE = MeanSquare()

CONVERGENCE = Convergence(
    steps=(0, 5, 10),
    scores=torch.tensor([[100.0, 25.0, 9.0], [64.0, 16.0, 4.0], [nan, nan, nan], [81.0, 36.0, 16.0]]),
    polished=(1, 0, 3),
    polished_scores=(6.25, 5.76, nan),
)


def drawn(convergence, score, metric=MEAN_SQUARE):
    with style():
        figure = Figure(figsize=(9, 7))
        ax = figure.add_axes((0.1, 0.1, 0.85, 0.75))
        draw_convergence(ax, convergence, score, metric)
        figure.draw_without_rendering()
    return ax


def words(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_every_start_is_a_line_of_root_mean_square_errors():
    lines = [line for line in drawn(CONVERGENCE, 5.76).lines if line.get_color() == START]
    assert len(lines) == 4
    assert np.allclose(lines[0].get_ydata(), [10, 5, 3])


def test_the_start_that_was_polished_best_stands_out():
    (line,) = (line for line in drawn(CONVERGENCE, 5.76).lines if line.get_color() == BEST)
    assert np.allclose(line.get_ydata(), [10, 5, 3])


def test_feasible_polished_scores_are_marks_to_the_right_of_the_last_step():
    (marks,) = (line for line in drawn(CONVERGENCE, 5.76).lines if line.get_marker() == "D")
    assert np.allclose(marks.get_ydata(), [2.5, 2.4])
    assert (marks.get_xdata() > 10).all()


def test_what_did_not_become_feasible_is_counted():
    assert "2 polished, feasible (1 did not become so)" in words(drawn(CONVERGENCE, 5.76))


def test_the_axis_says_that_early_layouts_may_overlap():
    assert "may overlap" in drawn(CONVERGENCE, 5.76).get_xlabel()


def test_the_designs_error_is_a_line():
    ax = drawn(CONVERGENCE, 5.76)
    assert any(np.allclose(line.get_ydata(), 2.4) and len(line.get_ydata()) == 2 for line in ax.lines)
    assert "design: 2.400 mm" in words(ax)


def test_negative_scores_are_drawn_themselves_on_a_linear_axis():
    circles = Convergence((0, 5), torch.tensor([[-0.1, -0.12], [-0.05, -0.13]]), (0,), (-0.14,))
    ax = drawn(circles, -0.14, metric=None)
    assert ax.get_yscale() == "linear"
    assert "design: -0.1400" in words(ax)


def test_the_axis_and_the_legend_have_the_metrics_unit():
    shares = Convergence((0, 5), torch.tensor([[4e-4, 1e-4]]), (0,), (1e-4,))
    ax = drawn(shares, 1e-4, Relative())
    assert ax.get_ylabel() == "relative RMSE (%)"
    assert "design: 1.000 %" in words(ax)


def test_nothing_polished_is_drawn():
    short = Convergence((0,), torch.tensor([[4.0], [9.0]]), (1,), ())
    assert "0 polished, feasible" in words(drawn(short, 4.0))


def test_the_legend_is_not_cut():
    many = Convergence((0, 5), torch.full((128, 2), 4.0), tuple(range(16)), (1.643,) * 10 + (nan,) * 6)
    ax = drawn(many, 1.643)
    assert ax.get_legend().get_window_extent().x1 < ax.figure.bbox.x1
    assert ax.get_legend().get_window_extent().y1 < ax.figure.bbox.y1
