import re
from xml.etree import ElementTree

import pytest

from multilens.plot.page import DOT, LINE, WIDE, errors_svg, layout_svg
from multilens.plot.svg import SVG
from multilens.problem import Problem
from multilens.tolerance import Tolerance


def parts(svg):
    return {element.get("id") for element in ElementTree.fromstring(svg).iter() if element.get("id")}


def test_lenses_and_best_pairs_can_be_named(cases):
    found = parts(layout_svg(*cases["phone 4"], "layout", "a back"))
    assert {f"layout-lens-{i}" for i in (1, 2, 3, 4)} <= found
    assert "layout-pair-1-2" in found


def test_the_back_is_to_scale(cases):
    problem, layout = cases["island 4"]
    root = ElementTree.fromstring(layout_svg(problem, layout, "layout", "a back"))
    widths = []
    for i in range(4):
        (path,) = root.find(f".//*[@id='layout-lens-{i + 1}']").iter(f"{{{SVG}}}path")
        x = [float(number) for number in re.findall(r"(-?[\d.]+) -?[\d.]+", path.get("d"))]
        widths.append(max(x) - min(x))
    bodies = [2 * (radius + 3.0) for radius in layout.aperture_radius.tolist()]
    scale = (WIDE - 60) / 45
    assert widths == pytest.approx([scale * body for body in bodies], abs=0.02)


@pytest.mark.parametrize(
    "name", ["phone 1", "phone 12", "island 8", "disc", "long line", "tiers", "limited", "thesis line"]
)
def test_nothing_is_drawn_outside_of_the_pictures(cases, name):
    problem, layout = cases[name]
    tolerance = Tolerance(mm=1.0)
    for svg in (layout_svg(problem, layout, "a", "a"), errors_svg(problem, layout, "b", "b", tolerance, [], []).svg):
        root = ElementTree.fromstring(svg)
        width, height = (float(side) for side in root.get("viewBox").split()[2:])
        for text in root.iter(f"{{{SVG}}}text"):
            assert 0 <= float(text.get("x", 0)) <= width, text.text
            assert 0 <= float(text.get("y", 0)) <= height, text.text


def test_a_question_without_depths_has_a_back(cases):
    assert "back-lens-9" in parts(layout_svg(*cases["unit square"], "back", "a square"))


def test_marks_go_where_the_curves_are(cases):
    problem, layout = cases["phone 2"]
    assert isinstance(problem, Problem)
    picture = errors_svg(problem, layout, "errors", "curves", None, [200.0, 1000.0, 5000.0], [1e-9, 1.0, float("inf")])
    assert {f"errors-{LINE}", f"errors-{DOT}", "errors-curve-1"} <= parts(picture.svg)
    (left, bottom), (middle, _), (right, top) = picture.marks
    assert (left, bottom) == (0, 0)
    assert right == pytest.approx(picture.across, abs=0.01)
    # Depths stand by their logarithm: 1 m is as many factors of 5 from 0.2 m as 5 m is from 1 m.
    assert middle == pytest.approx(picture.across / 2, abs=0.01)
    assert top < -100
