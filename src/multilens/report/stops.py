"""What a design does at one depth after the other: the stops of the report's slider."""

from bisect import bisect_right
from dataclasses import dataclass
from math import sqrt

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.bands import NOTHING, Band, errors_at, winner_bands
from multilens.cues import Measurement
from multilens.fusion import Best
from multilens.layout import Layout
from multilens.optics.thin_lens import circle_of_confusion
from multilens.problem import Problem

MOST_DEPTHS = 512
"""Depths of a problem that are stops; of more, so many evenly chosen."""


@dataclass(frozen=True)
class Stop:
    """What is told of one depth.

    Args:
        depth: Z, mm.
        measurement: the best one there, straight ahead; `bands.NOTHING` where every one fails.
        error: of its depth, mm; None where nothing measures.
        counted: error of all that counts at this depth, mm: of all measurements that are fused, over the field, with the guess.
        baseline: between the two lenses of a pair, mm; None for a lens alone.
        blur: diameter of the disc into which a point at this depth spreads on the sensor of each lens of the measurement, mm, in
            the sharpest of its tiers unless the measurement is of one; None where the focus is too near for a real image.
    """

    depth: float
    measurement: Measurement
    error: float | None
    counted: float
    baseline: float | None
    blur: tuple[float | None, ...]


def stops(problem: Problem, layout: Layout) -> tuple[Stop, ...]:
    """Give the depths at which a design is told, from near to far, and what it does at each.

    They are the problem's own depths, as far as there are not too many, the foci within them and the middle of every band.

    Args:
        problem: what is asked, of a device as it is drawn.
        layout: one layout, not a batch.
    """
    bands = winner_bands(problem, layout)
    depths = _depths(problem, layout, bands)
    errors = errors_at(problem, layout, depths)
    with torch.no_grad():
        counted = problem.squared_error(layout.to(torch.float64), depths).sqrt().tolist()
    starts = [band.near for band in bands]
    found = []
    for column, depth in enumerate(depths.tolist()):
        best = bands[bisect_right(starts, depth) - 1].measurement
        error = None if best == NOTHING else errors[problem.measurements.index(best), column].item()
        blur = tuple(blur_of(problem, layout, best, lens, depth) for lens in best.lenses)
        found.append(Stop(depth, best, error, counted[column], baseline_of(layout, best), blur))
    return tuple(found)


def baseline_of(layout: Layout, measurement: Measurement) -> float | None:
    """Give the distance of the two lenses of a pair, mm; None for a lens alone."""
    if len(measurement.lenses) != 2:
        return None
    first, second = measurement.lenses
    return (layout.position[first] - layout.position[second]).norm().item()


def blur_of(problem: Problem, layout: Layout, measurement: Measurement, lens: int, depth: float) -> float | None:
    """Give the diameter of the blur of a point at a depth on the sensor of one lens of a measurement, mm, as `Stop.blur`."""
    tiers = range(problem.lenses[lens].tiers) if measurement.tier is None else [measurement.tier]
    foci = [layout.focus[lens, tier].item() for tier in tiers]
    focal_length = problem.lenses[lens].focal_length
    numbers = (
        focal_length,
        layout.aperture_radius[lens].item(),
        min(foci, key=lambda z: abs(1 / z - 1 / depth)),
        depth,
    )
    if numbers[2] <= focal_length:
        return None
    return circle_of_confusion(*(torch.tensor(number, dtype=torch.float64) for number in numbers)).abs().item()


def what_counts(problem: Problem) -> str:
    """Name what counts at a depth beside the best measurement straight ahead; empty where nothing does."""
    parts = [
        "all measurements together" if not isinstance(problem.fusion, Best) else "",
        "over the field" if problem.field is not None else "",
        "with the guess" if problem.prior_error is not None else "",
    ]
    return ", ".join(filter(None, parts))


def _depths(problem: Problem, layout: Layout, bands: tuple[Band, ...]) -> Float[Tensor, " m"]:
    own = problem.depths.unique()
    if len(own) > MOST_DEPTHS:
        own = own[torch.linspace(0, len(own) - 1, MOST_DEPTHS, dtype=torch.float64).round().long()]
    near, far = own[0].item(), own[-1].item()
    foci = layout.focus.detach().double().flatten()
    middles = own.new_tensor([sqrt(band.near * band.far) for band in bands])
    return torch.cat([own, foci[(foci > near) & (foci < far)], middles.clamp(near, far)]).unique()
