"""The layouts that the study compares: each a question, and what is locked in it."""

from dataclasses import dataclass, replace

from hydra import compose, initialize_config_dir

import multilens as ml
from multilens.app.build import build_problem, typed
from multilens.app.compose import config_folder
from multilens.app.schema import register

APPLE = ((14.17, 14.17), (14.17, 33.41), (32.16, 23.79))
"""Lens centres of an iPhone 15 Pro Max, mm from the top left of the back. Source: Apple's Accessory Design Guidelines, as
transcribed by github.com/idcrook/psychic-winner."""

SEED = 0
"""Fixed before the first search."""


@dataclass(frozen=True)
class Case:
    """One row of the table.

    Args:
        name: for files.
        title: for people.
        experiment: the preset that it starts from.
        places: of the lenses, mm, where they are locked; otherwise empty.
        count: of the lenses.
    """

    name: str
    title: str
    experiment: str
    count: int
    places: tuple[tuple[float, float], ...] = ()

    def problem(self) -> ml.Problem:
        """Give the question."""
        register()
        with initialize_config_dir(str(config_folder()), version_base="1.3"):
            config = compose("config", [f"experiment={self.experiment}", f"lenses.count={self.count}"])
        problem = build_problem(typed(config))
        if not self.places:
            return problem
        lenses = [replace(lens, position=place) for lens, place in zip(problem.lenses, self.places, strict=True)]
        return ml.Problem(problem.back, lenses, problem.depths, problem.weights, problem.cues, problem.gap)

    def design(self) -> ml.Design:
        """Give the best layout that the default search finds."""
        return ml.solve(self.problem(), seed=SEED)


CASES = (
    Case("apple", "Apple's three places", "phone_back_island", 3, APPLE),
    Case("island_3", "three lenses, camera island", "phone_back_island", 3),
    Case("island_4", "four lenses, camera island", "phone_back_island", 4),
    Case("back_3", "three lenses, whole back", "phone_back", 3),
    Case("back_4", "four lenses, whole back", "phone_back", 4),
)
