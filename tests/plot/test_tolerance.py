"""The bar stands where the tolerance is kept, and the line where errors may be."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from multilens.metrics import Relative
from multilens.plot.errors import draw_errors
from multilens.plot.tolerance import BAR, draw_tolerance
from multilens.problem import Problem
from multilens.tolerance import Tolerance
from multilens.working_range import working_range


@pytest.fixture
def drawn(cases):
    problem, layout = cases["phone 2"]
    axes = Figure().add_subplot()
    draw_errors(axes, problem, layout)
    return axes, problem, layout


@pytest.mark.parametrize("tolerance", [Tolerance(mm=2), Tolerance(percent=0.1), Tolerance(mm=1e-6)])
def test_a_bar_stands_at_every_stretch_within_tolerance(drawn, tolerance: Tolerance):
    axes, problem, layout = drawn
    before = axes.get_xlim(), axes.get_ylim()
    draw_tolerance(axes, problem, layout, tolerance)
    bars = [patch.get_bbox() for patch in axes.patches]
    assert [(bar.x0, bar.x1) for bar in bars] == list(working_range(problem, layout, tolerance).intervals)
    assert all(bar.y1 == BAR for bar in bars)
    assert (axes.get_xlim(), axes.get_ylim()) == before


def test_the_line_is_what_is_allowed(drawn):
    axes, problem, layout = drawn
    draw_tolerance(axes, problem, layout, Tolerance(percent=0.1))
    depths, allowed = axes.lines[-1].get_data()
    np.testing.assert_allclose(np.asarray(allowed), 1e-3 * np.asarray(depths))


def test_the_line_is_in_the_unit_of_the_metric(cases):
    problem, layout = cases["phone 2"]
    relative = Problem(problem.back, problem.lenses, problem.depths, metric=Relative())
    axes = Figure().add_subplot()
    draw_errors(axes, relative, layout)
    draw_tolerance(axes, relative, layout, Tolerance(percent=0.1))
    np.testing.assert_allclose(np.asarray(axes.lines[-1].get_ydata()), 0.1)


def test_the_words_name_the_tolerance(drawn):
    axes, problem, layout = drawn
    draw_tolerance(axes, problem, layout, Tolerance(mm=12.5, percent=0.25))
    assert axes.texts[-1].get_text() == "dots and bar: error at most 12.5 mm and 0.25 % of the depth"
