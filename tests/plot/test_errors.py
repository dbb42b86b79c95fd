from functools import cache
from itertools import combinations

import numpy as np
import pytest
import torch
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from multilens.bands import winner_bands
from multilens.cues import LimitedStereo
from multilens.cues.limits import PairLimits
from multilens.field_of_view import Field
from multilens.fusion import InverseVariance
from multilens.layout import Layout
from multilens.metrics import InverseDepth, Relative, WorstCase
from multilens.plot.errors import draw_errors, draw_winners
from multilens.plot.figures import design_figures, overview_figure
from multilens.plot.page import LEFT, WIDE
from multilens.plot.style import style
from multilens.plot.svg import page_figure
from multilens.problem import Problem


@pytest.fixture
def measured(case):
    if not isinstance(case[0], Problem):
        pytest.skip("has no depths")
    return case


@cache
def drawn(draw, problem, layout, size=(5.65, 1.7), margin=0.0):
    with style():
        figure = Figure(figsize=size)
        draw(figure.add_axes((margin, margin, 1 - 2 * margin, 1 - 2 * margin)), problem, layout)
        figure.draw_without_rendering()
    return figure


def on_a_page(problem, layout):
    with style():
        figure = page_figure(WIDE, 300)
        draw_errors(figure.add_axes((LEFT / WIDE, 0.2, 1 - (LEFT + 12) / WIDE, 0.6)), problem, layout)
    return figure


def test_the_bar_has_a_part_for_each_band(measured):
    ax = drawn(draw_winners, *measured).axes[0]
    parts = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in ax.patches if isinstance(patch, Rectangle)]
    assert np.allclose(parts, [(band.near, band.far) for band in winner_bands(*measured)])


def test_words_of_the_bar_keep_apart_and_whole(measured):
    figure = drawn(draw_winners, *measured)
    boxes = {text: text.get_window_extent() for text in figure.axes[0].texts}
    overlapping = [
        (a.get_text(), b.get_text())
        for a, b in combinations(boxes, 2)
        if min(boxes[a].x1, boxes[b].x1) - max(boxes[a].x0, boxes[b].x0) > 0.5
        and min(boxes[a].y1, boxes[b].y1) - max(boxes[a].y0, boxes[b].y0) > 0.5
    ]
    assert not overlapping
    outside = [text.get_text() for text, box in boxes.items() if box.y0 < 0 or box.y1 > figure.bbox.y1]
    assert not outside


def test_every_winner_is_named_where_there_is_room(cases):
    words = [text.get_text() for text in drawn(draw_winners, *cases["island 4"]).axes[0].texts]
    assert {band.measurement.label for band in winner_bands(*cases["island 4"])} <= set(words)


def test_where_nothing_measures_there_is_no_bold_line_and_the_bar_says_so(cases):
    problem, layout = cases["limited"]
    near = 1000 * float(torch.pdist(layout.position).min()) * 6.86 / 738
    bold = [line.get_xdata() for line in drawn(draw_errors, problem, layout).axes[0].lines if line.get_linewidth() == 3]
    assert min(x.min() for x in bold) == pytest.approx(near)
    assert "nothing" in [text.get_text() for text in drawn(draw_winners, problem, layout).axes[0].texts]


def test_crossings_are_written_below_the_bar(cases):
    problem, layout = cases["thesis line"]
    words = [text.get_text() for text in drawn(draw_winners, problem, layout).axes[0].texts]
    # Zf / (1 + 2 A / b) with Zf = 40, A = 1 and b = 48.
    assert "38.4" in words


def test_more_bands_than_fit_are_counted(cases):
    problem, layout = cases["phone 12"]
    words = [text.get_text() for text in drawn(draw_winners, problem, layout, size=(1.2, 1.7)).axes[0].texts]
    assert any(word.startswith("too narrow to label:") for word in words)


def test_depths_over_a_wide_range_are_logarithmic_and_over_a_narrow_one_linear(cases):
    wide, narrow = (drawn(draw_errors, *cases[name]).axes[0] for name in ("phone 4", "thesis line"))
    assert (wide.get_xscale(), wide.get_yscale()) == ("log", "log")
    assert (narrow.get_xscale(), narrow.get_yscale()) == ("linear", "linear")


def test_the_bold_line_is_never_above_a_thin_one(measured):
    ax = drawn(draw_errors, *measured).axes[0]
    bold = [line.get_xydata() for line in ax.lines if line.get_linewidth() == 3.0]
    thin = [line.get_xydata() for line in ax.lines if line.get_linewidth() == 0.8]
    assert len(thin) == len(measured[0].measurements)
    for part in bold:
        for curve in (curve[np.isfinite(curve[:, 1])] for curve in thin):
            assert (part[:, 1] <= np.interp(part[:, 0], *curve.T, left=np.inf, right=np.inf) * (1 + 1e-6)).all()


def test_the_bold_line_of_a_pair_keeps_to_the_pair_where_its_reach_ends(cases):
    # The error of a pair goes with the square of the depth, also beside a jump to another pair.
    bold = [line for line in drawn(draw_errors, *cases["limited"]).axes[0].lines if line.get_linewidth() == 3.0]
    assert len(bold) > 1
    for line in bold:
        depth, error = line.get_xydata().T
        assert np.allclose(error / depth**2, error[0] / depth[0] ** 2, rtol=1e-2)


def test_the_axis_says_that_errors_are_straight_ahead_where_a_field_is_asked_for(cases):
    problem, layout = cases["phone 2"]
    field = Problem(problem.back, problem.lenses, problem.depths, field=Field.rings(60, 2))
    assert drawn(draw_errors, problem, layout).axes[0].get_ylabel() == "depth error (mm)"
    assert drawn(draw_errors, field, layout).axes[0].get_ylabel() == "depth error straight ahead (mm)"


@pytest.mark.parametrize(("metric", "power", "factor"), [(Relative(), 1, 100.0), (InverseDepth(), 0, 1000.0)])
def test_errors_are_in_the_unit_of_the_metric(cases, metric, power, factor):
    problem, layout = cases["phone 2"]
    ax = drawn(draw_errors, Problem(problem.back, problem.lenses, problem.depths, metric=metric), layout).axes[0]
    # Z^2 n / (b f) of the pair, in % of Z or in 1/m of 1/Z.
    depth, error = ax.lines[0].get_data()
    gain = problem.lenses[0].disparity_noise / (float(torch.pdist(layout.position)) * 6.86)
    np.testing.assert_allclose(error, factor * gain * np.asarray(depth) ** power, rtol=1e-9)
    assert ax.get_ylabel() == f"depth error ({metric.unit})"


def test_where_nothing_measures_the_figure_is_in_the_picture_and_the_axis_upright(cases):
    problem, layout = cases["phone 2"]
    blind = [LimitedStereo(PairLimits(max_disparity=1e-6))]
    asked = Problem(
        problem.back, problem.lenses, problem.depths, cues=blind, metric=Relative(), fusion=InverseVariance()
    )
    ax = drawn(draw_errors, asked, layout).axes[0]
    (dashed,) = (line for line in ax.lines if line.get_linestyle() == "--")
    low, high = ax.get_ylim()
    assert low < dashed.get_ydata()[0] < high


def test_the_dashed_line_is_the_figure_of_the_design(cases):
    problem, layout = cases["phone 2"]
    worst = Problem(problem.back, problem.lenses, problem.depths, metric=WorstCase(Relative()))
    ax = drawn(draw_errors, worst, layout).axes[0]
    (dashed,) = (line for line in ax.lines if line.get_linestyle() == "--")
    best = [line.get_ydata().max() for line in ax.lines if line.get_linewidth() == 3.0]
    # The best measurement is worst at an end of the depths, which is one of those that are asked for.
    assert max(best) == pytest.approx(dashed.get_ydata()[0])
    assert ax.get_legend().get_texts()[-1].get_text().startswith("worst relative error 0.")


@pytest.mark.parametrize("draw", [overview_figure, lambda *asked: design_figures(*asked)["errors"], on_a_page])
def test_the_longest_words_beside_the_curves_are_whole(cases, draw):
    problem, layout = cases["phone 4"]
    asked = {"metric": WorstCase(InverseDepth()), "fusion": InverseVariance(), "field": Field.rings(60, 2)}
    figure = draw(Problem(problem.back, problem.lenses, problem.depths, **asked), layout)
    figure.draw_without_rendering()
    (ax,) = (ax for ax in figure.axes if ax.get_legend())
    for box in (ax.get_legend().get_window_extent(), ax.yaxis.label.get_window_extent()):
        assert box.x0 >= 0
        assert box.x1 <= figure.bbox.x1


def test_the_zeros_of_defocus_do_not_stretch_a_logarithmic_axis(cases):
    low, high = drawn(draw_errors, *cases["phone 4"]).axes[0].get_ylim()
    assert 10 < high / low < 1e6


def test_the_root_mean_square_is_drawn_and_written(cases):
    problem, layout = cases["phone 4"]
    ax = drawn(draw_errors, problem, layout).axes[0]
    rmse = problem.score(layout).sqrt().item()
    assert any(np.allclose(line.get_ydata(), rmse) for line in ax.lines)
    assert f"RMSE {rmse:.2f} mm" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_measurements_together_are_a_line_below_the_best(cases):
    problem, layout = cases["phone 4"]
    together = Problem(problem.back, problem.lenses, problem.depths, fusion=InverseVariance())
    ax = drawn(draw_errors, together, layout).axes[0]
    (fused,) = (line for line in ax.lines if line.get_linewidth() == 1.4)
    for line in (line for line in ax.lines if line.get_linewidth() == 3):
        assert (np.interp(line.get_xdata(), *fused.get_data()) <= line.get_ydata() * (1 + 1e-3)).all()
    words = [text.get_text() for text in drawn(draw_winners, together, layout).axes[0].texts]
    assert any(word.startswith("measurement that tells most") for word in words)


@pytest.mark.parametrize(("max_disparity", "told"), [(0.1, True), (1e3, False)])
def test_the_guess_has_a_line_only_where_it_is_needed(cases, max_disparity, told):
    problem, layout = cases["phone 4"]
    limited = Problem(
        problem.back, problem.lenses, problem.depths, cues=[LimitedStereo(PairLimits(max_disparity=max_disparity))]
    )
    legend = drawn(draw_errors, limited, layout).axes[0].get_legend()
    assert ("with the guess" in [text.get_text() for text in legend.get_texts()]) == told


def test_the_legend_of_measurements_together_is_not_cut(cases):
    problem, layout = cases["phone 4"]
    together = Problem(problem.back, problem.lenses, problem.depths, fusion=InverseVariance())
    for figure in (overview_figure(together, layout), design_figures(together, layout)["errors"]):
        figure.draw_without_rendering()
        legends = [ax.get_legend() for ax in figure.axes if ax.get_legend()]
        assert legends
        assert all(legend.get_window_extent().x1 < figure.bbox.x1 for legend in legends)


def test_one_unit_of_depth_for_a_picture(cases):
    assert drawn(draw_errors, *cases["phone 4"]).axes[0].get_xlabel() == "depth (m)"
    assert drawn(draw_errors, *cases["thesis line"]).axes[0].get_xlabel() == "depth (mm)"


def test_a_problem_of_one_depth_is_drawn(cases):
    problem, layout = cases["phone 2"]
    single = Problem(problem.back, problem.lenses, [500.0])
    assert len(drawn(draw_winners, single, layout).axes[0].patches) == 1
    drawn(draw_errors, single, layout)


def test_errors_that_are_all_zero_are_drawn(cases):
    problem, _ = cases["phone 1"]
    single = Problem(problem.back, problem.lenses, [500.0])
    drawn(draw_errors, single, Layout([(9, 10)], [1.0], [500.0]))
