"""Draw the pictures of the pages again: `python docs/figures.py` writes them into docs/images, in about a minute.

Each is drawn by `multilens.plot` from a problem and a layout, found or given. The same versions give the same bytes.
"""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.plot.figures import design_figures, overview_figure
from multilens.plot.style import style

IMAGES = Path(__file__).parent / "images"

DOTS_PER_INCH = 130
"""A wide picture is 1733 pixels across."""

MAIN = ml.Lens(6.86, (0.5, 1.93), clearance=6.17, disparity_noise=0.000244, blur_noise=0.000244)
"""The lens of the physics page."""


def given(*words: str) -> ml.Problem:
    """Give the problem that a command line asks for."""
    return build_problem(read_given(list(words)).config)


def four_lenses() -> Figure:
    """Four main cameras on the camera island of a phone: experiment=phone_back_island."""
    problem = given("experiment=phone_back_island")
    return overview_figure(problem, ml.solve(problem, starts=64, patience=12).layout)


def scanner() -> Figure:
    """The scanner of the tutorial."""
    back = ml.Back.rounded_rectangle(60, 120, corner=8)
    back = back.keep_out("hand", ml.rectangle(60, 65, centre=(30, 87.5), corner=8))
    back = back.keep_out("lamp", ml.disc((30, 12), 5), clearance=1)
    back = back.keep_out("reader", ml.rectangle(16, 8, centre=(30, 40)), clearance=0.5)
    camera = ml.Lens.from_f_number(4, (2, 8), clearance=4.5, disparity_noise=0.00028, blur_noise=0.00028)
    problem = ml.Problem(back, [camera] * 3, ml.log_depths(150, 1500, 512))
    return overview_figure(problem, ml.solve(problem, starts=64, patience=12).layout)


def cues() -> Figure:
    """Stereo of two lenses 20 mm apart, and defocus of each."""
    problem = ml.Problem(ml.Back.rectangle(40, 20), [MAIN] * 2, ml.log_depths(200, 5000, 512))
    layout = ml.Layout([[10, 10], [30, 10]], [1.93, 1.93], [1000, 2600])
    return design_figures(problem, layout)["errors"]


def room() -> Figure:
    """Bodies on a back with keep-outs, one lens of them locked."""
    back = ml.Back.rounded_rectangle(60, 40, corner=8)
    back = back.keep_out("flash", ml.disc((30, 9), 3), clearance=2)
    back = back.keep_out("microphone", ml.rectangle(8, 4, centre=(48, 32)), clearance=1)
    problem = ml.Problem(back, [MAIN] * 3, ml.log_depths(200, 5000, 512), gap=1)
    layout = ml.Layout([[8.1, 8.1], [51.9, 15], [25, 31]], [1.93, 1.93, 1.2], [2800, 3600, 4500])
    return design_figures(problem, layout)["layout"]


def foci() -> Figure:
    """Six equal lenses on 70 x 150 mm: two make the baseline, all share out the depths."""
    problem = ml.Problem(ml.Back.rectangle(70, 150), [MAIN] * 6, ml.log_depths(200, 5000, 512))
    return design_figures(problem, ml.solve(problem, starts=32, patience=2, proof=0).layout)["errors"]


def tiers() -> Figure:
    """One principal eye of a jumping spider, its four retinas in focus where they serve best."""
    eye = given("experiment=devices/jumping_spider").lenses[0]
    problem = ml.Problem(ml.Back.disc(5), [eye], ml.linear_depths(20, 50, 200), cues=[ml.LensDefocus()])
    return design_figures(problem, ml.evaluate(problem).layout)["errors"]


FIGURES: tuple[Callable[[], Figure], ...] = (four_lenses, scanner, cues, room, foci, tiers)
"""Each draws the picture of its own name."""


def png(figure: Figure) -> bytes:
    """Give a figure as a PNG of 256 colours: a fourth of the size, and lines and words do not need more."""
    drawn, small = BytesIO(), BytesIO()
    with style():
        figure.savefig(drawn, dpi=DOTS_PER_INCH, metadata={"Software": None})
    Image.open(drawn).convert("RGB").quantize(method=Image.Quantize.MAXCOVERAGE, kmeans=3).save(
        small, "PNG", optimize=True
    )
    return small.getvalue()


def main() -> None:
    """Draw them all, each into its file."""
    for draw in FIGURES:
        (IMAGES / f"{draw.__name__}.png").write_bytes(png(draw()))
        print(draw.__name__)


if __name__ == "__main__":
    main()
