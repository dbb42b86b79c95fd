"""Three families of spiders: their eyes as they stand, pair by pair, at the depths of the thesis' figure 7.1."""

from dataclasses import dataclass, replace

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given

PAIRS = ("anterior median", "anterior lateral", "posterior median", "posterior lateral")
"""In the order of the presets, left and right of each."""

RANGES = ((20, 50), (30, 70), (80, 120), (100, 200))
"""Of figure 7.1, mm; the fifth, 300 to 500 mm, is beyond what spiders of this size hunt."""

DEPTHS = 200

SEED = 0
"""Fixed before the first search."""


@dataclass(frozen=True)
class Family:
    """One family.

    Args:
        name: of its experiment, devices/NAME.
        title: for people.
        hunts: depths at which it hunts, mm.
    """

    name: str
    title: str
    hunts: tuple[int, int]

    def problem(self, near: float, far: float, cues: str = "stereo_and_defocus") -> ml.Problem:
        """Give all eight eyes over a range of depths."""
        words = [f"experiment=devices/{self.name}", f"cues={cues}", f"depth={{near: {near}, far: {far}}}"]
        words += [f"depth.count={DEPTHS}", "depth.spacing=linear"]
        return build_problem(read_given(words).config)


FAMILIES = (
    Family("crab_spider", "crab spider", (20, 50)),
    Family("wolf_spider", "wolf spider", (20, 50)),
    Family("jumping_spider", "jumping spider", (80, 120)),
)


def pair_of(problem: ml.Problem, pair: str) -> ml.Problem:
    """Give the question of one pair of eyes alone."""
    first = 2 * PAIRS.index(pair)
    return replace(problem, lenses=problem.lenses[first : first + 2])


def with_tiers(problem: ml.Problem, tiers: int) -> ml.Problem:
    """Give the question with this many tiers in every eye."""
    return replace(problem, lenses=[replace(lens, tiers=tiers) for lens in problem.lenses])
