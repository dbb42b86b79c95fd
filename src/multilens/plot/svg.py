"""A figure as SVG text to stand inside a page: small, its words as words, its ids unlike those of the page's other pictures."""

import re
from collections.abc import Mapping
from io import StringIO
from xml.etree import ElementTree

from matplotlib import rc_context
from matplotlib.figure import Figure

from multilens.plot.style import style

SVG, LINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"

POINTS_PER_INCH = 72

NUMBER = re.compile(r"-?\d+\.\d+")
REFERENCE = re.compile(r"url\(#([^)]+)\)")
FONTS = re.compile(r"font-family: [^;]*;|'DejaVu Sans'.*?sans-serif")
SHAPES = ("d", "x", "y", "points", "transform", "width", "height")
"""Attributes whose numbers are points on the paper."""

ElementTree.register_namespace("", SVG)
ElementTree.register_namespace("xlink", LINK)


def page_figure(width: float, height: float) -> Figure:
    """Give an empty figure of a size in points, whose pixels are points, as they are in its SVG text."""
    return Figure(figsize=(width / POINTS_PER_INCH, height / POINTS_PER_INCH), dpi=POINTS_PER_INCH, facecolor="none")


def inline_svg(
    figure: Figure,
    name: str,
    label: str,
    titles: Mapping[str, str] | None = None,
    links: Mapping[str, str] | None = None,
    role: str = "img",
) -> str:
    """Give a figure as an SVG element; the same figure gives the same text.

    Args:
        figure: drawn.
        name: with which every id begins, followed by a hyphen; the element itself has it as its id.
        label: what the picture shows, for those who cannot see it.
        titles: words that belong to a part, by the id that the part was given.
        links: words that belong to a link, by where it leads.
        role: of the element; "group" where its parts are links.
    """
    text = StringIO()
    with style(), rc_context({"svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    root = ElementTree.fromstring(text.getvalue())
    # A rule for every element of the page; the page has one for its pictures.
    root.remove(root[0])
    for element in root.iter():
        _fit_into_page(element, name)
    for part, words in (titles or {}).items():
        for element in root.iterfind(f".//*[@id='{name}-{part}']"):
            title = ElementTree.Element(f"{{{SVG}}}title")
            title.text = words
            element.insert(0, title)
    for link in root.iter(f"{{{SVG}}}a"):
        words = (links or {}).get(link.attrib["href"])
        if words is not None:
            link.attrib["aria-label"] = words
            ElementTree.SubElement(link, f"{{{SVG}}}title").text = words
    del root.attrib["width"], root.attrib["height"]
    root.attrib |= {"id": name, "role": role, "aria-label": label}
    return ElementTree.tostring(root, encoding="unicode")


def _fit_into_page(element: ElementTree.Element, name: str) -> None:
    """Give an element ids of this picture, links within the page, coordinates of a hundredth of a point, the page's font."""
    attributes, link = element.attrib, f"{{{LINK}}}href"
    if "id" in attributes:
        attributes["id"] = f"{name}-{attributes['id']}"
    if "clip-path" in attributes:
        attributes["clip-path"] = REFERENCE.sub(rf"url(#{name}-\1)", attributes["clip-path"])
    if element.tag == f"{{{SVG}}}a":
        # The name of the attribute that HTML and SVG have in common.
        attributes["href"] = attributes.pop(link)
        attributes.pop("target", None)
    elif link in attributes:
        attributes[link] = attributes[link].replace("#", f"#{name}-", 1)
    for shape in SHAPES:
        if shape in attributes:
            attributes[shape] = " ".join(NUMBER.sub(_rounded, attributes[shape]).split())
    if "style" in attributes:
        attributes["style"] = REFERENCE.sub(rf"url(#{name}-\1)", FONTS.sub("", attributes["style"]))
    if not (element.text or "").strip():
        element.text = None
    element.tail = None


def _rounded(number: re.Match[str]) -> str:
    return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")
