"""Backs and layouts that are hard to draw, and what is asked of every picture."""

from itertools import combinations, product

import pytest
import shapely
from matplotlib.text import Text

from multilens.back import Back
from multilens.cues import LimitedStereo, PairLimits
from multilens.depths import linear_depths, log_depths
from multilens.geometry.shape import disc, rectangle
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.score_problem import ScoreProblem
from multilens.sweep_row import SweepRow

NOISE = 0.2 * 1.22e-3
FOCI = [4820, 3110, 2050, 1400, 930, 620, 410, 280, 350, 240, 700, 1100]
ON_PHONE = [
    (9, 10), (67, 150), (66, 11), (10, 149), (38, 16), (38, 140),
    (9, 60), (67, 60), (9, 100), (67, 100), (18, 28), (58, 30),
]  # fmt: skip
ON_ISLAND = [(8, 8), (36, 30), (10, 36), (22, 22), (38, 20), (22, 38), (8, 22), (20, 8)]


def lens(clearance, **others):
    return Lens(6.86, (0.1, 1.93), (200, 5000), clearance, NOISE, NOISE, **others)


def with_sensors(back):
    back = back.keep_out("flash", disc((32.16, 10.22), 3.45), 0.5).keep_out("mic", disc((37.95, 33.86), 0.375), 0.5)
    return back.keep_out("lidar", rectangle(4.06, 7.06, (32.16, 38.22)), 0.5)


PHONE = with_sensors(Back.rounded_rectangle(76.73, 159.86, 13)).keep_out("logo", disc((38.4, 79.9), 28.75))
ISLAND = with_sensors(Back(rectangle(45.0, 46.0, corner=12.0)))
ISLANDS = Back(shapely.MultiPolygon([shapely.box(0, 0, 30, 20), shapely.box(60, 40, 100, 60)]))
DEPTHS = log_depths(200, 5000, 32)


def on(back, places, clearance, radius=1.93, **others):
    count = len(places)
    return Problem(back, [lens(clearance, **others)] * count, DEPTHS), Layout(places, [radius] * count, FOCI[:count])


def thesis_line():
    line = Lens(24, (1, 24), (20, 50), position=(None, 25))
    return Problem(Back.rectangle(50, 50), [line] * 2, linear_depths(20, 50, 32)), Layout(
        [(1, 25), (49, 25)], [1, 1], [47.175, 40]
    )


def tiers():
    problem = Problem(ISLAND, [lens(4.0, tiers=4), lens(4.0)], DEPTHS)
    return problem, Layout([(10, 10), (36, 25)], [1.93] * 2, [[300, 700, 1500, 4000], [500] * 4])


def limited():
    cues = [LimitedStereo(PairLimits(max_disparity=0.738))]
    return Problem(PHONE, [lens(5.8)] * 4, DEPTHS, cues=cues), Layout(ON_PHONE[:4], [1.93] * 4, FOCI[:4])


def unit_square():
    problem = ScoreProblem(Back.rectangle(1, 1), [Lens(1, (0.01, 0.5))] * 9, lambda layout: -layout.aperture_radius)
    return problem, Layout([(0.2 + 0.3 * (i % 3), 0.2 + 0.3 * (i // 3)) for i in range(9)], [0.1] * 9, [1.0] * 9)


CASES = {f"phone {n}": on(PHONE, ON_PHONE[:n], 5.8) for n in (1, 2, 4, 8, 12)}
CASES |= {f"island {n}": on(ISLAND, ON_ISLAND[:n], 3.0) for n in (1, 2, 4, 8)}
CASES |= {
    "disc": on(Back.disc(30), [(-20, 0), (10, 20), (10, -20)], 3.0),
    "islands": on(ISLANDS, [(5, 5), (94, 55), (25, 15), (65, 55)], 2.0),
    "long line": on(Back.rectangle(120, 3), [(2, 1.5), (118, 1.5), (30, 1.5), (33, 1.5)], 0.5, 0.5),
    "tiny lenses": on(PHONE, [(12, 9.5), (65, 150), (14, 9.5), (14, 11.5), (12, 11.5)], 0.0, 0.3),
    "tiers": tiers(),
    "limited": limited(),
    "thesis line": thesis_line(),
    "unit square": unit_square(),
}


@pytest.fixture(params=CASES)
def case(request):
    return CASES[request.param]


@pytest.fixture
def cases():
    return CASES


def swept(keys, error, unit=("RMSE", "mm"), bound=0.9):
    """Give rows of a sweep over every combination of values, each with a back and apertures that its settings tell.

    `error` gives the figure for settings, or the status of a job that found nothing.
    """
    rows = []
    for job, values in enumerate(product(*keys.values())):
        settings = dict(zip(keys, values, strict=True))
        figure = error(settings)
        if isinstance(figure, str):
            rows.append(SweepRow(job, tuple(settings.items()), figure, "no room"))
            continue
        metric = unit(settings) if callable(unit) else unit
        count = int(settings.get("lenses.count", 2))
        found = {"metric": metric[0], "unit": metric[1], "figure": figure, "score": figure**2, "rmse": figure}
        proved = None if bound is None else bound * figure**2
        areas = {"aperture_area": 11.65 * count, "back_area": float(settings.get("back.outline.width", 50)) ** 2}
        rows.append(
            SweepRow(
                job, tuple(settings.items()), "complete", lens_count=count, bound=proved, measured=1.0, **found, **areas
            )
        )
    return rows


def words_of(figure):
    unseen = set()
    for axis in (each for ax in figure.axes for each in (ax.xaxis, ax.yaxis)):
        low, high = sorted(axis.get_view_interval())
        margin = 1e-9 * (high - low)
        for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]:
            # Ticks off the axis, and all of one that is hidden, are there and not drawn.
            if not low - margin <= tick.get_loc() <= high + margin or not axis.axes.axison:
                unseen |= {tick.label1, tick.label2}
    return [text for text in figure.findobj(Text) if text.get_text() and text.get_visible() and text not in unseen]


def overlapping(texts):
    """Give the pairs of words that cover each other."""
    boxes = {text: text.get_window_extent() for text in texts}
    return [
        (a.get_text(), b.get_text())
        for a, b in combinations(boxes, 2)
        if min(boxes[a].x1, boxes[b].x1) - max(boxes[a].x0, boxes[b].x0) > 0.5
        and min(boxes[a].y1, boxes[b].y1) - max(boxes[a].y0, boxes[b].y0) > 0.5
    ]


@pytest.fixture(name="swept")
def swept_fixture():
    return swept


@pytest.fixture
def clear():
    """What is asked of a whole figure: no words cut by its edge, none over others."""

    def check(figure):
        figure.draw_without_rendering()
        texts = words_of(figure)
        whole = figure.bbox
        for text in texts:
            box = text.get_window_extent()
            assert box.x0 >= 0, text
            assert box.y0 >= 0, text
            assert box.x1 <= whole.x1, text
            assert box.y1 <= whole.y1, text
        assert not overlapping(texts)

    return check
