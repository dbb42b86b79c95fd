from itertools import pairwise
from xml.etree import ElementTree

import pytest

from multilens.plot.linked import Series, linked_svg
from multilens.plot.svg import SVG

NEAR = Series("near", "#0072b2", ((1.0, 4.0, "#job-1"), (2.0, 2.0, "#job-2")), "default")
FAR = Series("far", "#e69f00", ((2.0, 8.0, "#job-3"),), None)


@pytest.fixture(scope="module")
def root():
    words = {"#job-1": "job 1", "#job-2": "job <2>", "#job-3": "job 3"}
    return ElementTree.fromstring(linked_svg([NEAR, FAR], ("lenses", "RMSE (mm)"), "chart", "errors", words, True))


def links(root):
    return {link.get("href"): link for link in root.iter(f"{{{SVG}}}a")}


def test_every_point_is_a_link_with_its_words(root):
    found = links(root)
    assert {target: link.get("aria-label") for target, link in found.items()} == {
        "#job-1": "job 1",
        "#job-2": "job <2>",
        "#job-3": "job 3",
    }
    assert all(link[-1].text == link.get("aria-label") for link in found.values())


def test_points_stand_where_their_numbers_are(root):
    def place(target):
        (use,) = links(root)[target].iter(f"{{{SVG}}}use")
        return float(use.get("x")), float(use.get("y"))

    (x1, y1), (x2, y2), (x3, y3) = (place(f"#job-{job}") for job in (1, 2, 3))
    assert x1 < x2 == x3
    assert y3 < y1 < y2
    # 2, 4 and 8 mm span a factor of 4: still on plain axes.
    assert (y1 - y3) == pytest.approx(2 * (y2 - y1), abs=0.05)


def test_what_its_parts_do_is_said(root):
    assert (root.get("role"), root.get("aria-label")) == ("group", "errors")
    words = [text.text for text in root.iter(f"{{{SVG}}}text")]
    assert {"lenses", "RMSE (mm)", "near", "far", "1", "2"} <= set(words)


def test_numbers_that_span_much_are_drawn_by_their_logarithms():
    series = Series("jobs", "#0072b2", ((1.0, 1.0, "#a"), (2.0, 10.0, "#b"), (3.0, 100.0, "#c")), "default")
    root = ElementTree.fromstring(linked_svg([series], ("lenses", "mm"), "chart", "errors", {}, True))
    y = [float(next(link.iter(f"{{{SVG}}}use")).get("y")) for link in root.iter(f"{{{SVG}}}a")]
    assert y[0] - y[1] == pytest.approx(y[1] - y[2], abs=0.05)


@pytest.mark.parametrize("count", [1, 8, 13])
def test_the_legend_stays_on_the_chart(count):
    series = [Series(f"back iphone_15_pro_max {k}", "#0072b2", ((1.0, k + 1.0, f"#{k}"),), None) for k in range(count)]
    root = ElementTree.fromstring(linked_svg(series, ("x", "y"), "chart", "errors", {}, False))
    _, _, width, height = map(float, root.get("viewBox").split())
    for text in root.iter(f"{{{SVG}}}text"):
        if text.text.startswith("back"):
            assert 0 < float(text.get("y")) < height
            assert float(text.get("x")) + 5.6 * len(text.text) < width


@pytest.mark.parametrize(("low", "high"), [(0.67046, 0.67054), (1200.0, 1200.5), (2.0, 2.7)])
def test_numbers_along_the_axis_keep_apart_however_long_they_are(low, high):
    alike = Series("alike", "#0072b2", ((low, 4.0, "#job-1"), (high, 4.1, "#job-2")), None)
    picture = linked_svg([alike], ("time (s)", "RMSE (mm)"), "chart", "errors", {"#job-1": "1", "#job-2": "2"}, False)
    texts = [
        text for text in ElementTree.fromstring(picture).iter(f"{{{SVG}}}text") if "middle" in text.get("style", "")
    ]
    ticks = [(float(text.get("x")), text.text) for text in texts if text.text not in ("time (s)", "RMSE (mm)")]
    assert len(ticks) > 1
    # A digit is 7 of 11 points wide at most.
    for (x, word), (beside, other) in pairwise(sorted(ticks)):
        assert beside - x > 7 * (len(word) + len(other)) / 2
