"""The same problem put to multilens: two cues of the study's own, and the one-dimensional back they are used on.

A cue is a frozen dataclass with two methods: `measurements` names what these lenses allow to be measured, and calling it gives
the error of each of them at each depth, differentiable in the layout.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

import multilens as ml
from multilens.cues import Cue, Measurement
from multilens.optics.defocus import focused_sensitivity
from multilens.optics.stereo import stereo_sensitivity

NANOMETRE = 1e-6
"""mm; apertures that touch count as that far apart, so that their error stays finite."""


@dataclass(frozen=True)
class GapStereo:
    """Stereo of lenses 1 and 2 with the gap between their rims for a baseline: err = Z^2 n / (b f)."""

    def measurements(self, lenses: Sequence[ml.Lens]) -> tuple[Measurement, ...]:
        """Name the one pair."""
        return (Measurement("stereo", (0, 1), None, "stereo across the gap"),)

    def __call__(
        self, layout: ml.Layout, lenses: Sequence[ml.Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch 1 z"]:
        """Give the depth error of the pair, mm; lens 2 says with which focal length and noise."""
        apart = (layout.position[..., 0, :] - layout.position[..., 1, :]).norm(dim=-1, keepdim=True)
        gap = (apart - layout.aperture_radius.sum(-1, keepdim=True)).clamp(min=NANOMETRE)
        return stereo_sensitivity(
            depths, gap.unsqueeze(-1), _like(layout, _focal_over(lenses[1].disparity_noise, lenses))
        )


@dataclass(frozen=True)
class SecondLensDefocus:
    """Differential defocus of lens 2 alone, as in the thesis: err = Z abs(Z - Zf) n / (2 A f)."""

    def measurements(self, lenses: Sequence[ml.Lens]) -> tuple[Measurement, ...]:
        """Name the one lens."""
        return (Measurement("defocus", (1,), 0, "defocus 2"),)

    def __call__(
        self, layout: ml.Layout, lenses: Sequence[ml.Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch 1 z"]:
        """Give the depth error of lens 2, mm."""
        radius, focus = layout.aperture_radius[..., 1:, None], layout.focus[..., 1:, :1]
        return focused_sensitivity(depths, radius, _like(layout, _focal_over(lenses[1].blur_noise, lenses)), focus)


def line_problem(depths: Float[Tensor, " z"], ratio: float, stereo: Cue, focal_length: float = 1.0) -> ml.Problem:
    """Ask for a pinhole and a lens of radius 1 to 24 mm on a line of 50 mm across a square back.

    Args:
        depths: mm.
        ratio: f_stereo / f_dfdd; it enters as a smaller noise of disparity.
        stereo: the cue with the baseline that is wanted.
        focal_length: f_dfdd, mm.
    """
    near, far = depths.min().item(), depths.max().item()
    hardware = {"disparity_noise": 1 / ratio, "position": (None, 25.0)}
    pinhole = ml.Lens(focal_length, (1.0, 1.0), **hardware)
    wide = ml.Lens(focal_length, (1.0, 24.0), focus=(near, far), **hardware)
    return ml.Problem(ml.Back.rectangle(50, 50), [pinhole, wide], depths, cues=[stereo, SecondLensDefocus()])


def _focal_over(noise: float, lenses: Sequence[ml.Lens]) -> float:
    return lenses[1].focal_length / noise


def _like(layout: ml.Layout, number: float) -> Tensor:
    return torch.tensor(number, dtype=layout.position.dtype, device=layout.position.device)
