from dataclasses import replace
from functools import cache
from itertools import combinations

import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.transforms import Bbox

from multilens.back import Back
from multilens.geometry.shape import rectangle
from multilens.layout import Layout
from multilens.plot.back import draw_layout
from multilens.plot.bare import best_pairs
from multilens.plot.style import style
from multilens.problem import Problem

TOUCH = 0.5
"""Pixels that two boxes may share: they are whole pixels, the words are not."""


@cache
def drawn(problem, layout, size=(6.35, 6.4)):
    with style():
        figure = Figure(figsize=size)
        draw_layout(figure.add_axes((0, 0, 1, 1)), problem, layout)
        figure.draw_without_rendering()
    return figure


def word_boxes(figure):
    texts = [text for ax in figure.axes for text in ax.texts]
    return {text: text.get_window_extent() for text in texts if text.get_text()}


def shares_area(a, b):
    across, up = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
    return across > TOUCH and up > TOUCH


def test_no_words_overlap(case):
    boxes = word_boxes(drawn(*case))
    assert not [(a.get_text(), b.get_text()) for a, b in combinations(boxes, 2) if shares_area(boxes[a], boxes[b])]


def test_no_words_are_cut(case):
    figure = drawn(*case)
    whole = figure.bbox
    for text, box in word_boxes(figure).items():
        assert (box.x0 >= whole.x0, box.y0 >= whole.y0, box.x1 <= whole.x1, box.y1 <= whole.y1) == (True,) * 4, text


def test_each_lens_is_a_body_and_an_aperture_to_scale(case):
    problem, layout = case
    circles = [patch for patch in drawn(problem, layout).axes[0].patches if isinstance(patch, Circle)]
    apertures = layout.aperture_radius.tolist()
    bodies = [radius + lens.clearance for radius, lens in zip(apertures, problem.lenses, strict=True)]
    assert sorted(circle.radius for circle in circles) == pytest.approx(sorted(apertures + bodies))


def test_a_millimetre_is_alike_in_both_directions_and_y_runs_down(case):
    ax = drawn(*case).axes[0]
    (x0, y0), (x1, y1) = ax.transData.transform([(0, 0), (1, 1)])
    assert (x1 - x0, y1 - y0) == pytest.approx((x1 - x0, -(x1 - x0)))
    assert x1 > x0


def test_the_whole_back_is_on_the_paper(case):
    problem, layout = case
    ax = drawn(problem, layout).axes[0]
    left, top, right, bottom = problem.back.outline.bounds
    assert ax.get_xlim()[0] < left < right < ax.get_xlim()[1]
    assert ax.get_ylim()[1] < top < bottom < ax.get_ylim()[0]


def test_every_lens_is_numbered_on_the_back_and_in_the_table(cases):
    words = [text.get_text() for text in word_boxes(drawn(*cases["phone 12"]))]
    assert all(words.count(str(number)) == 2 for number in range(1, 13))


def test_names_stand_in_the_table_where_they_tell_one_lens_from_another(cases):
    problem, layout = cases["phone 2"]
    lenses = [replace(lens, name=name) for lens, name in zip(problem.lenses, ("main", "ultra-wide"), strict=True)]
    words = [text.get_text() for text in word_boxes(drawn(Problem(problem.back, lenses, problem.depths), layout))]
    assert {"name", "main", "ultra-wide"} <= set(words)


def test_a_lens_off_the_back_is_drawn_whole(cases):
    problem, layout = cases["phone 2"]
    off = Layout([[130.0, -25.0], [66.0, 11.0]], layout.aperture_radius, layout.focus)
    ax = drawn(problem, off).axes[0]
    bodies = [patch for patch in ax.patches if isinstance(patch, Circle) and patch.get_gid()]
    edges = [patch.get_window_extent() for patch in bodies]
    assert len(edges) == 2
    assert all(
        ax.bbox.x0 <= box.x0 and box.x1 <= ax.bbox.x1 and ax.bbox.y0 <= box.y0 and box.y1 <= ax.bbox.y1 for box in edges
    )


def test_every_keep_out_is_named(cases):
    words = [text.get_text() for text in word_boxes(drawn(*cases["phone 4"]))]
    assert {"flash", "mic", "lidar", "logo"} <= set(words)


@pytest.mark.parametrize("size", [(4.4, 4.4), (5.2, 5.2), (6.0, 6.0)])
def test_a_name_does_not_cover_a_smaller_keep_out(cases, size):
    problem, layout = cases["phone 2"]
    back = Back(problem.back.outline)
    for x, name in ((14, "microphone"), (20, "a"), (8, "b")):
        back = back.keep_out(name, rectangle(1.5, 1.5, (x, 120.0)))
    figure = drawn(type(problem)(back, problem.lenses, problem.depths), layout, size)
    (box,) = (box for text, box in word_boxes(figure).items() if text.get_text() == "microphone")
    for part in back.keep_outs:
        left, top, right, bottom = part.shape.bounds
        corners = figure.axes[0].transData.transform([(left, bottom), (right, top)])
        assert not shares_area(box, Bbox(corners))


def test_a_name_with_dollar_signs_is_written_as_it_stands(cases):
    problem, layout = cases["disc"]
    back = problem.back.keep_out("$5 $\\frac part", problem.back.outline.__class__(problem.back.outline.core, 2.0))
    figure = drawn(type(problem)(back, problem.lenses, problem.depths), layout)
    assert "$5 $\\frac part" in [text.get_text() for text in word_boxes(figure)]


def test_all_foci_of_a_lens_with_tiers_are_in_the_table(cases):
    words = [text.get_text() for text in word_boxes(drawn(*cases["tiers"]))]
    assert "0.300  0.700  1.50  4.00" in words


def test_the_best_pair_is_the_widest_and_its_length_is_written(cases):
    problem, layout = cases["islands"]
    assert [pair.lenses for pair in best_pairs(problem, layout)] == [(0, 1)]
    words = [text.get_text() for text in word_boxes(drawn(problem, layout))]
    assert "102.1 mm" in words


def test_a_problem_without_depths_has_no_foci_and_no_baselines(cases):
    figure = drawn(*cases["unit square"])
    assert not [text for text in word_boxes(figure) if "focus" in text.get_text()]
    assert not figure.axes[0].collections


def test_every_two_lenses_are_joined(cases):
    (joins,) = drawn(*cases["phone 12"]).axes[0].collections
    assert len(joins.get_segments()) == 12 * 11 // 2


@pytest.mark.parametrize("size", [(4.0, 4.0), (12.0, 4.0), (4.0, 9.0)])
def test_words_keep_apart_on_paper_of_other_sizes(cases, size):
    boxes = word_boxes(drawn(*cases["island 4"], size=size))
    assert not [(a.get_text(), b.get_text()) for a, b in combinations(boxes, 2) if shares_area(boxes[a], boxes[b])]
