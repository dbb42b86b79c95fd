"""Predicted working ranges over all settings, and what they cover of what is published."""

from dataclasses import dataclass
from math import inf

import torch
from published import MEAN_ABSOLUTE, Claim
from settings import Setting, sizes
from systems import PREDICT
from torch import Tensor

import multilens as ml

DEPTHS = ml.log_depths(50, 200_000, 900)
"""mm; each is 0.93 % beyond the last, so that an end is known to 1 %."""


def errors(system: str, swept: list[Setting], depths: Tensor = DEPTHS) -> dict[str, Tensor]:
    """Give the standard deviation of the depth under every setting, mm, [settings, depths], by how it is measured.

    Of a texture of all sizes the best one is read at each depth.
    """
    found = [[PREDICT[system](size, depths) for size in sizes(setting)] for setting in swept]
    return {way: torch.stack([_least([each[way] for each in read]) for read in found]) for way in found[0][0]}


def _least(read: list[Tensor]) -> Tensor:
    return torch.stack(read).amin(0)


def kept(claim: Claim, error: Tensor, depths: Tensor = DEPTHS) -> Tensor:
    """Say at which depths the mean absolute error is within what a claim states."""
    allowed = claim.mm if claim.mm is not None else depths * (claim.percent or 0.0) / 100
    return error * MEAN_ABSOLUTE <= allowed


def asked(claim: Claim, depths: Tensor = DEPTHS) -> Tensor:
    """Say which depths are in the published range."""
    return (depths >= claim.near) & (depths <= claim.far)


def longest(within: Tensor, depths: Tensor = DEPTHS) -> tuple[float, float] | None:
    """Give both ends of the longest stretch, as a ratio of its ends, in which the error is kept."""
    best, start = None, None
    for k, inside in enumerate([*within.tolist(), False]):
        if inside and start is None:
            start = k
        elif not inside and start is not None:
            if best is None or k - 1 - start > best[1] - best[0]:
                best = (start, k - 1)
            start = None
    return None if best is None else (depths[best[0]].item(), depths[best[1]].item())


@dataclass(frozen=True)
class Band:
    """What the settings of a system predict, measured in one way.

    Args:
        claim: that it is held against.
        texture: of one size or of all.
        way: how depth is measured.
        count: of the settings.
        share: of the settings that keep the error at each depth, 0 to 1.
        covers: which settings keep it over the whole published range.
        ends: near and far end of the longest stretch of every setting that keeps the error anywhere, mm.
    """

    claim: Claim
    texture: str
    way: str
    count: int
    share: Tensor
    covers: Tensor
    ends: tuple[tuple[float, float], ...]

    @property
    def covering(self) -> float:
        """Share of the settings that keep the error over the whole published range."""
        return self.covers.double().mean().item()

    @property
    def measuring(self) -> float:
        """Share of the settings that keep the error anywhere."""
        return len(self.ends) / self.count

    def spread(self, end: int) -> tuple[float, float, float]:
        """Give the least, the median and the largest near (0) or far (1) end, mm."""
        found = sorted(ends[end] for ends in self.ends)
        return (found[0], found[len(found) // 2], found[-1]) if found else (inf, inf, inf)


def band(claim: Claim, texture: str, way: str, error: Tensor, depths: Tensor = DEPTHS) -> Band:
    """Sum up the errors of all settings."""
    within = kept(claim, error, depths)
    covers = within[:, asked(claim, depths)].all(-1)
    stretches = (longest(line, depths) for line in within)
    ends = tuple(ends for ends in stretches if ends is not None)
    return Band(claim, texture, way, len(error), within.double().mean(0), covers, ends)


def shift_per_error(depth: float, baseline: float, focal_length: float) -> float:
    """Give the shift on the sensor that moves a point by a mm of depth, b f / Z^2."""
    return baseline * focal_length / depth**2
