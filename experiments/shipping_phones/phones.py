"""The phones of the study: as they ship, over the spacings that are plausible, and their islands."""

from dataclasses import dataclass, replace
from itertools import combinations
from math import dist

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given

SEED = 0
"""Fixed before the first search."""

ROOM = 0.5
"""Distance that bodies keep from each other at the least spacing that is plausible, mm."""

WIDEST = 26.0
"""Largest distance of neighbours that is plausible, mm: the widest that is published is 20.4, of the iPhone 15 Pro Max."""

Place = tuple[float, float]


@dataclass(frozen=True)
class Phone:
    """One row of the table.

    Args:
        name: of its experiment, devices/NAME.
        title: for people.
        island: name of the back that is its camera island; None takes the least rectangle around its bodies.
        published: whether the distances between its lenses are.
    """

    name: str
    title: str
    island: str | None = None
    published: bool = False

    def problem(self, *words: str) -> ml.Problem:
        """Give the phone as it ships, under the question of the presets or another one, key=value."""
        return build_problem(read_given([f"experiment=devices/{self.name}", *words]).config)


PHONES = (
    Phone("iphone_13_pro", "iPhone 13 Pro", "iphone_13_pro_island", published=True),
    Phone("iphone_15_pro_max", "iPhone 15 Pro Max", "iphone_15_pro_max_island", published=True),
    Phone("pixel_4", "Pixel 4", published=True),
    Phone("iphone_14", "iPhone 14"),
    Phone("iphone_14_pro", "iPhone 14 Pro"),
    Phone("pixel_7", "Pixel 7"),
    Phone("pixel_7_pro", "Pixel 7 Pro"),
    Phone("find_x5_pro", "Find X5 Pro"),
    Phone("galaxy_s23", "Galaxy S23"),
    Phone("galaxy_s23_ultra", "Galaxy S23 Ultra"),
)


def spacing(problem: ml.Problem) -> float:
    """Give the distance of the two nearest lenses, mm."""
    return min(dist(one, other) for one, other in combinations(places(problem), 2))


def plausible(problem: ml.Problem) -> tuple[float, float]:
    """Give the least and the largest distance of neighbours that is plausible, mm: from bodies that all but touch."""
    bodies = sorted(lens.aperture_radius[1] + lens.clearance for lens in problem.lenses)
    return bodies[-1] + bodies[-2] + ROOM, WIDEST


def spread(problem: ml.Problem, neighbours: float) -> ml.Problem:
    """Give the phone with its pattern of lenses scaled about its middle, so that neighbours stand this far apart."""
    here = places(problem)
    centre = [sum(axis) / len(here) for axis in zip(*here, strict=True)]
    scale = neighbours / spacing(problem)
    there = [tuple(c + scale * (p - c) for p, c in zip(place, centre, strict=True)) for place in here]
    return replace(problem, lenses=[replace(lens, position=at) for lens, at in zip(problem.lenses, there, strict=True)])


def freed(problem: ml.Problem, island: str | None) -> ml.Problem:
    """Give the question where the same lenses go best in the same island."""
    back = around(problem) if island is None else build_problem(read_given([f"back={island}"]).config).back
    return replace(problem, back=back, lenses=[replace(lens, position=None) for lens in problem.lenses])


def around(problem: ml.Problem) -> ml.Back:
    """Give the least rectangle that holds the bodies of the lenses where they stand."""
    bodies = [lens.aperture_radius[1] + lens.clearance for lens in problem.lenses]
    sides = []
    for axis in (0, 1):
        ends = [(place[axis] - body, place[axis] + body) for place, body in zip(places(problem), bodies, strict=True)]
        sides.append((min(low for low, _ in ends), max(high for _, high in ends)))
    (left, right), (top, bottom) = sides
    # A hair more than touching: two bodies that fill a rectangle exactly leave a search nowhere to begin.
    width, height = right - left + 2e-3, bottom - top + 2e-3
    return ml.Back(ml.rectangle(width, height, ((left + right) / 2, (top + bottom) / 2)))


def places(problem: ml.Problem) -> list[Place]:
    """Give where the lenses stand; all are locked."""
    return [lens.position for lens in problem.lenses]  # pyright: ignore[reportReturnType] -- locked in both coordinates
