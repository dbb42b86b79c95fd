from xml.etree import ElementTree

import pytest

from multilens.plot.style import style
from multilens.plot.svg import SVG, inline_svg, page_figure


def drawn():
    with style():
        figure = page_figure(200, 100)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.plot([0, 1], [0, 1], gid="curve")
        (point,) = axes.plot([0.5], [0.5], "o", gid="point", clip_on=False)
        point.set_url("#job-3")
        axes.text(0.5, 0.5, "<b> & $x$", parse_math=False)
    return figure


@pytest.fixture(scope="module")
def root():
    return ElementTree.fromstring(inline_svg(drawn(), "picture", "a line", {"curve": "the <line>"}))


def test_a_point_is_a_unit_of_the_picture(root):
    assert root.get("viewBox") == "0 0 200 100"
    assert root.get("width") is None


def test_whoever_cannot_see_it_is_told(root):
    assert (root.get("role"), root.get("aria-label")) == ("img", "a line")


def test_every_id_begins_with_the_name_of_the_picture(root):
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert ids[0] == "picture"
    assert all(name.startswith("picture-") for name in ids[1:])
    assert "picture-curve" in ids


def test_a_part_has_its_title(root):
    assert root.find(".//*[@id='picture-curve']")[0].text == "the <line>"


def test_words_stay_words(root):
    assert [text.text for text in root.iter(f"{{{SVG}}}text") if "b" in text.text] == ["<b> & $x$"]


def test_a_link_stays_on_the_page(root):
    (link,) = root.iter(f"{{{SVG}}}a")
    assert link.attrib == {"href": "#job-3"}


def test_no_rule_of_the_picture_reaches_the_page(root):
    assert not list(root.iter(f"{{{SVG}}}style"))


def test_the_same_figure_gives_the_same_text():
    assert inline_svg(drawn(), "picture", "a line") == inline_svg(drawn(), "picture", "a line")
