"""The problems of the benchmark, fixed before the first run: backs, lenses and depths of every kind that the library knows."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from json import dumps
from math import cos, pi, sin

from shapely import MultiPolygon, box

import multilens as ml
from multilens.records import problem_record

NOISE = 0.000244
"""mm; 0.2 pixels of 1.22 um, as in the presets of a phone's lenses."""

BLOB_CORNERS = 200


@dataclass(frozen=True)
class Case:
    """One problem.

    Args:
        name: in tables and files.
        build: gives the problem.
        convex: whether the back is convex and without keep-outs.
        quick: whether a quick run has it.
    """

    name: str
    build: Callable[[], ml.Problem]
    convex: bool
    quick: bool = False

    @property
    def problem(self) -> ml.Problem:
        """The problem, the same object whenever it is asked for."""
        return _built(self.name)


@cache
def _built(name: str) -> ml.Problem:
    return next(case.build() for case in CASES if case.name == name)


def fingerprint(problem: ml.Problem) -> str:
    """Give a text of 16 digits that is another one as soon as anything about the problem is."""
    return sha256(dumps(problem_record(problem), sort_keys=True).encode()).hexdigest()[:16]


def rectangle() -> ml.Back:
    """Give a plain rectangle of about a phone's size."""
    return ml.Back.rectangle(70, 150)


def disc() -> ml.Back:
    """Give a round back of 50 mm across."""
    return ml.Back.disc(25)


def phone() -> ml.Back:
    """Give the whole back of a phone, round corners and four keep-outs: the numbers of the preset iphone_15_pro_max."""
    back = _with_sensors(ml.Back.rounded_rectangle(76.73, 159.86, 13))
    return back.keep_out("logo", ml.disc((38.365, 79.93), 28.75))


def island() -> ml.Back:
    """Give the camera island of a phone with three keep-outs: the numbers of the preset iphone_15_pro_max_island."""
    return _with_sensors(ml.Back(ml.rectangle(45, 46, centre=(24, 24.5), corner=12)))


def _with_sensors(back: ml.Back) -> ml.Back:
    return (
        back.keep_out("flash", ml.disc((32.16, 10.22), 3.45))
        .keep_out("microphone", ml.disc((37.95, 33.86), 0.375))
        .keep_out("lidar", ml.rectangle(4.06, 7.06, centre=(32.16, 38.22)))
    )


def l_shape() -> ml.Back:
    """Give an L of 80 x 80 mm with limbs 30 mm wide."""
    return ml.Back(ml.polygon([(0, 0), (80, 0), (80, 30), (30, 30), (30, 80), (0, 80)]))


def two_islands() -> ml.Back:
    """Give two islands 12 mm apart: 30 x 50 mm and 40 x 24 mm."""
    return ml.Back(MultiPolygon([box(0, 0, 30, 50), box(42, 10, 82, 34)]))


def blob() -> ml.Back:
    """Give a smooth outline of 200 corners, not convex: radius 40 (1 + 0.18 cos 3t + 0.08 sin 5t) mm at the angle t."""
    turns = [2 * pi * corner / BLOB_CORNERS for corner in range(BLOB_CORNERS)]
    reach = [40 * (1 + 0.18 * cos(3 * turn) + 0.08 * sin(5 * turn)) for turn in turns]
    return ml.Back(ml.polygon([(r * cos(turn), r * sin(turn)) for r, turn in zip(reach, turns, strict=True)]))


def main_lens(clearance: float = 6.17) -> ml.Lens:
    """Give a phone's main camera, f/1.78 to f/11."""
    return ml.Lens(6.86, (0.31, 1.93), (200, 5000), clearance, NOISE, NOISE)


def tele_lens(clearance: float = 6.49) -> ml.Lens:
    """Give a phone's camera of longer focal length, f/2.8 to f/11, in focus from 600 mm on."""
    return ml.Lens(9.0, (0.41, 1.61), (600, 5000), clearance, NOISE, NOISE)


def wide_lens(clearance: float = 5.0) -> ml.Lens:
    """Give a phone's camera of short focal length, f/2.2 to f/11; its body is an estimate."""
    return ml.Lens(2.22, (0.1, 0.5), (100, 5000), clearance, NOISE, NOISE)


def eye(least: float = 1.0, largest: float = 24.0, focal_length: float = 1.0) -> ml.Lens:
    """Give a lens in the thesis' scalars, noise 1, whose aperture is bounded by little but the room there is."""
    return ml.Lens(focal_length, (least, largest))


def _rectangle_of_main_lenses(count: int) -> Callable[[], ml.Problem]:
    return lambda: ml.Problem(rectangle(), [main_lens()] * count, ml.log_depths(200, 5000, 512))


def _disc_of_eyes(count: int) -> Callable[[], ml.Problem]:
    return lambda: ml.Problem(disc(), [eye()] * count, ml.linear_depths(20, 50, 256))


CASES = (
    Case("2 rectangle", _rectangle_of_main_lenses(2), True, quick=True),
    Case("2 disc", _disc_of_eyes(2), True),
    Case("3 island", lambda: ml.Problem(island(), [main_lens()] * 3, ml.log_depths(200, 5000, 512)), False),
    Case(
        "3 blob, mixed",
        lambda: ml.Problem(
            blob(), [eye(1, 30), eye(2, 12, 1.5), eye(0.5, 20, 0.7)], ml.linear_depths(30, 120, 256), gap=0.5
        ),
        False,
    ),
    Case("4 rectangle", _rectangle_of_main_lenses(4), True),
    Case("4 phone", lambda: ml.Problem(phone(), [main_lens()] * 4, ml.log_depths(200, 5000, 512)), False, quick=True),
    Case("4 disc", _disc_of_eyes(4), True),
    Case(
        "6 L, mixed",
        lambda: ml.Problem(
            l_shape(),
            [*[main_lens()] * 3, *[tele_lens()] * 2, wide_lens()],
            ml.log_depths(300, 4000, 384),
        ),
        False,
    ),
    Case(
        "6 two islands, mixed",
        lambda: ml.Problem(
            two_islands(),
            [eye(1, 15), eye(1, 15), eye(2, 8, 1.4), eye(2, 8, 1.4), eye(0.5, 20, 0.8), eye(3, 3, 1.2)],
            ml.linear_depths(40, 160, 256),
        ),
        False,
    ),
    Case(
        "6 island, mixed",
        lambda: ml.Problem(
            island(),
            [*[main_lens(3.0)] * 2, *[tele_lens(3.5)] * 2, *[wide_lens(2.5)] * 2],
            ml.log_depths(200, 5000, 512),
            gap=0.5,
        ),
        False,
    ),
    Case("8 rectangle", _rectangle_of_main_lenses(8), True, quick=True),
    Case("8 blob", lambda: ml.Problem(blob(), [eye(1, 30)] * 8, ml.log_depths(30, 300, 256), gap=0.5), False),
    Case("12 disc", _disc_of_eyes(12), True),
    Case(
        "12 phone, mixed",
        lambda: ml.Problem(
            phone(),
            [*[main_lens()] * 6, *[tele_lens()] * 4, *[wide_lens()] * 2],
            ml.log_depths(200, 5000, 512),
        ),
        False,
    ),
)
