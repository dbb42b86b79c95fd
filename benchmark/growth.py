"""How the time of the search's work grows with the size of the problem."""

from math import cos, pi, sin
from typing import Any

import torch

import multilens as ml
from benchmark.problems import main_lens
from benchmark.speed import BATCH, DEPTHS, LENSES, question, random_layouts, seconds_each, value_and_gradient
from multilens.search.barrier import BarrierSettings, settle
from multilens.search.sight import Seer
from multilens.search.solve import BATCH as TOGETHER
from multilens.search.starts import scattered_starts
from multilens.search.variables import Variables

COUNTS, DEPTH_COUNTS, STARTS, VERTICES = (2, 4, 8, 16), (32, 128, 512), (64, 256, 1024), (20, 2000)

STEPS = 20
"""Of a search that is timed, to the mean of a step."""


def growth_table() -> list[list[Any]]:
    """Give a row for each size, head first: what grows, how large it is, microseconds a design, and of what."""
    rows: list[list[Any]] = [["grows", "to", "microseconds a design", "of"]]
    for what, sizes in (("lenses", COUNTS), ("depths", DEPTH_COUNTS), ("starts", STARTS)):
        for size in sizes:
            count, depths, batch = (
                size if what == name else usual
                for name, usual in (("lenses", LENSES), ("depths", DEPTHS), ("starts", BATCH))
            )
            problem = question(count, depths)
            layout = random_layouts(problem, batch, {"dtype": torch.float32})
            seconds = seconds_each(lambda at=layout, asked=problem: value_and_gradient(asked.score, at))
            rows.append([what, size, 1e6 * seconds / batch, "value and gradient, float32"])
    steps = {vertices: search_step(vertices) for vertices in VERTICES}
    # In turn, the least of several: what else the machine does only adds.
    for vertices in VERTICES * 2:
        steps[vertices] = min(steps[vertices], search_step(vertices))
    return rows + [
        ["outline vertices", vertices, 1e6 * seconds / TOGETHER, "step of the search, with all limits, float64"]
        for vertices, seconds in steps.items()
    ]


def search_step(vertices: int) -> float:
    """Give the mean time of a step of the search on an outline of so many vertices, for a batch of starts, s."""
    problem = ml.Problem(star(vertices), [main_lens()] * LENSES, ml.log_depths(200, 5000, DEPTHS))
    variables = Variables(problem)
    share = variables.spread(scattered_starts(problem, variables, TOGETHER, 0))
    seer, settings = Seer(problem, variables), BarrierSettings(steps=STEPS)
    return seconds_each(lambda: settle(seer, share, settings)) / STEPS


def star(vertices: int) -> ml.Back:
    """Give a back of so many vertices, radius 60 (1 + 0.1 cos 5t) mm at the angle t: no polygon of fewer vertices."""
    turns = [2 * pi * corner / vertices for corner in range(vertices)]
    reach = [60 * (1 + 0.1 * cos(5 * turn)) for turn in turns]
    return ml.Back(ml.polygon([(r * cos(turn), r * sin(turn)) for r, turn in zip(reach, turns, strict=True)]))
