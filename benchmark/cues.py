"""What the search takes for other cues than the thesis', whose score has no closed form: time, and how well it ends."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from statistics import median
from time import perf_counter
from typing import Any

import multilens as ml
from benchmark.problems import main_lens, phone
from multilens.cues import Cue, LensDefocus, PairStereo
from multilens.cues.photometric import PhotometricDefocus, PhotometricStereo
from multilens.scene import Scene
from multilens.sensor import Sensor

SEEDS, LONGER_SEED = (0, 1, 2), 3
"""Of the searches that are timed, and of a longer one that shows how good they are; fixed before the first run."""

PATIENCE = 24
"""Of the longer search, twice the usual."""

SENSOR = Sensor(pixel_pitch_um=1.22, full_well=5060, read_noise=3, efficiency=0.5)
"""Of a phone's main camera: the numbers of the preset iphone_main."""

SCENE = Scene(contrast=0.2, cycles_per_mm=50, light_lux=500, exposure_ms=33.3, pixels=1089)
"""The numbers of the preset office."""

POWER_CHANGE = 1.0
"""Dioptres between the two images of differential defocus."""

CUES: dict[str, Sequence[Cue]] = {
    "thesis": (PairStereo(), LensDefocus()),
    "photometric": (PhotometricStereo(SCENE), PhotometricDefocus(SCENE, POWER_CHANGE)),
}


def question(cues: Sequence[Cue]) -> ml.Problem:
    """Give four main cameras anywhere on a phone's back."""
    return ml.Problem(phone(), [replace(main_lens(), sensor=SENSOR)] * 4, ml.log_depths(200, 5000, 512), cues=cues)


def searched(problem: ml.Problem, **settings: int) -> ml.Design:
    """Give the design of a search with its default settings but these; no bound is sought, which photometric cues do not have."""
    return ml.solve(problem, proof=0, **settings)


def cues_table(solve: Callable[..., ml.Design] = searched, seeds: Sequence[int] = SEEDS) -> list[list[Any]]:
    """Give a row for each kind of cue, head first; medians over the seeds, the search with its default settings.

    Args:
        solve: from a problem, a seed and a patience to a design.
        seeds: of the timed searches.
    """
    rows: list[list[Any]] = [
        ["cues", "time (s)", "times the thesis' cues", "above the best found (%)", "worst seed (%)"]
    ]
    for name, cues in CUES.items():
        problem, seconds, scores = question(cues), [], []
        for seed in seeds:
            began = perf_counter()
            scores.append(solve(problem, seed=seed).score)
            seconds.append(perf_counter() - began)
        best = min(*scores, solve(problem, seed=LONGER_SEED, patience=PATIENCE).score)
        above = [100 * (score / best - 1) for score in scores]
        first = rows[1][1] if len(rows) > 1 else median(seconds)
        rows.append([name, median(seconds), median(seconds) / first, median(above), max(above)])
    return rows
