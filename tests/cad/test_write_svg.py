from pathlib import Path
from xml.etree import ElementTree

import pytest

from multilens.back import Back
from multilens.cad.export import export
from multilens.cad.layers import LAYERS
from multilens.cad.plan import Plan, Stand
from multilens.cad.write_svg import write_svg
from multilens.design import Design
from multilens.geometry.shape import disc

SPACE = "{http://www.w3.org/2000/svg}"


def test_a_unit_is_a_millimetre_and_all_of_the_back_is_on_the_page(back: Back):
    page = ElementTree.fromstring(write_svg(Plan(back)))
    x, y, width, height = map(float, page.get("viewBox", "").split())
    assert (page.get("width"), page.get("height")) == (f"{width!r}mm", f"{height!r}mm")
    left, top, right, bottom = back.outline.bounds
    assert x < left
    assert y < top
    assert x + width > right
    assert y + height > bottom


def test_a_lens_off_the_back_is_on_the_page(back: Back):
    stand = Stand(1, 130.0, -25.0, 2.0, 8.0, 5.0, 1.25, (300.0,))
    x, y, width, _ = map(float, ElementTree.fromstring(write_svg(Plan(back, (stand,)))).get("viewBox", "").split())
    assert x + width > 138.0
    assert y < -33.0


def test_every_layer_is_a_group_and_lenses_are_true_circles(design: Design, tmp_path: Path):
    export(design, tmp_path / "layout.svg")
    page = ElementTree.parse(tmp_path / "layout.svg").getroot()
    groups = {group.get("id"): group for group in page}
    assert set(groups) == set(LAYERS)
    drawn = [
        (float(circle.get("cx", "")), float(circle.get("cy", "")), float(circle.get("r", "")))
        for circle in groups["apertures"].iter(f"{SPACE}circle")
    ]
    places, radii = design.layout.position.tolist(), design.layout.aperture_radius.tolist()
    assert drawn == [(x, y, radius) for (x, y), radius in zip(places, radii, strict=True)]


@pytest.mark.parametrize("name", ["a < b & c", "\x00\x1b bell", "]]>", '"quoted"'])
def test_names_cannot_break_the_page(name: str):
    text = write_svg(Plan(Back.rectangle(10, 10).keep_out(name, disc((5, 5), 1))))
    titles = [title.text for title in ElementTree.fromstring(text).iter(f"{SPACE}title")]
    assert titles[1] == " ".join(name.replace("\x00", " ").replace("\x1b", " ").split())


def test_pens_are_as_thin_as_the_back_is_small():
    texts = [write_svg(Plan(Back.disc(radius))) for radius in (0.5, 50)]
    widths = [float(text.split('stroke-width="')[1].split('"')[0]) for text in texts]
    assert widths[1] == pytest.approx(100 * widths[0], rel=0.1)
