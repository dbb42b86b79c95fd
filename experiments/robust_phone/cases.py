"""What may happen to the devices, and the design against each."""

from dataclasses import dataclass

from hydra import compose, initialize_config_dir

import multilens as ml
from multilens.app.build import build_question, typed
from multilens.app.compose import config_folder
from multilens.app.schema import register
from multilens.question import Question

SEED = 0
"""Of every search and of its devices; fixed before the first search."""

OTHERS, OTHER_SEED = 1024, 1
"""Devices that no search has seen, on which every design is tried, and their seed."""

SEARCH = {"starts": 32, "patience": 2, "proof": 0, "seed": SEED}
"""The same for every design, the nominal one too."""

ISLAND = "experiment=phone_back_island"


def asked(*overrides: str) -> Question:
    """Give the question of a configuration."""
    register()
    with initialize_config_dir(str(config_folder()), version_base="1.3"):
        return build_question(typed(compose("config", [ISLAND, *overrides])))


@dataclass(frozen=True)
class Case:
    """One row of the table.

    Args:
        name: of the preset in conf/robust, and for files.
        title: for people.
    """

    name: str
    title: str

    def question(self) -> ml.Robust:
        """Give the question of many devices."""
        question = asked(f"robust={self.name}")
        assert isinstance(question, ml.Robust)
        return question

    def others(self) -> ml.Robust:
        """Ask the same of devices that no search has seen."""
        return self.question().afresh(OTHER_SEED, OTHERS)


CASES = (
    Case("assembly", "assembly: mean of devices"),
    Case("focus", "focus: mean of devices"),
    Case("finger", "finger: worst lens covered"),
    Case("all", "all: worst tenth of devices"),
)
