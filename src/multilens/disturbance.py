"""What sets the devices that are built and used apart from the one that was drawn."""

from dataclasses import dataclass, field

import torch
from jaxtyping import Float
from torch import Tensor
from torch.quasirandom import SobolEngine

from multilens.cues.drift import Drift
from multilens.layout import Layout
from multilens.optics.drift import refocused
from multilens.ranges import refuse_unless_not_negative

WITHIN = 1e-7
"""Share by which uniform numbers keep away from 0 and 1, whose normal numbers are infinite: 5 standard deviations remain."""


@dataclass(frozen=True)
class Disturbance:
    """How far off a device may be, and what may cover it.

    What assembly does is measured by the calibration of each device, so that it only changes what the device is. What drifts
    afterwards nobody knows: it falsifies the depth.

    Args:
        shift: of each lens as it is built, along x and along y, mm, standard deviation, >= 0.
        focus_dioptre: of one over the in-focus depth of each lens as it is built, dioptres, standard deviation, >= 0; all tiers
            of a lens alike.
        covered: probability that a finger covers one lens, any of them alike, from 0 to 1.
        drift: what moves after the calibration.

    Raises:
        ValueError: a number is out of its range.
    """

    shift: float = 0.0
    focus_dioptre: float = 0.0
    covered: float = 0.0
    drift: Drift = field(default_factory=Drift)

    def __post_init__(self) -> None:
        for name in ("shift", "focus_dioptre"):
            refuse_unless_not_negative(name, getattr(self, name))
        if not 0 <= self.covered <= 1:
            raise ValueError(f"covered must be from 0 to 1, got {self.covered:g}")

    @property
    def varies(self) -> bool:
        """Whether devices are built unlike each other, so that samples of them are needed."""
        return bool(self.shift or self.focus_dioptre)


@dataclass(frozen=True)
class Devices:
    """A sample of devices: by how much each lens of each is off.

    Args:
        shift: mm.
        vergence: added to one over the in-focus depth, 1/mm.
    """

    shift: Float[Tensor, "s n 2"]
    vergence: Float[Tensor, "s n"]

    def built(self, layout: Layout) -> Layout:
        """Give each device as it is built after a layout, [*batch, s], differentiable in the layout."""
        shift, vergence = self.shift.to(layout.position), self.vergence.to(layout.position)
        position = layout.position.unsqueeze(-3) + shift
        radius = layout.aperture_radius.unsqueeze(-2).expand(position.shape[:-1])
        return Layout(position, radius, refocused(layout.focus.unsqueeze(-3), vergence.unsqueeze(-1)))


def draw_devices(disturbance: Disturbance, count: int, samples: int, seed: int) -> Devices:
    """Draw devices from normal distributions, spread evenly and in mirrored pairs; one as drawn where devices do not vary.

    Of a pair one is off by as much as the other, the other way. So the mean of everything that is odd in the errors is exactly 0,
    as it is over all devices there could be.

    Args:
        disturbance: how far off they are.
        count: of lenses.
        samples: how many devices, even, >= 2.
        seed: of the scrambling; the same seed gives the same devices.

    Reference:
        A. B. Owen, Scrambling Sobol' and Niederreiter-Xing points (1998).
    """
    if not disturbance.varies:
        return Devices(torch.zeros(1, count, 2, dtype=torch.float64), torch.zeros(1, count, dtype=torch.float64))
    uniform = SobolEngine(3 * count, scramble=True, seed=seed).draw(samples // 2, dtype=torch.float64)
    half = torch.special.ndtri(uniform.clamp(WITHIN, 1 - WITHIN))
    normal = torch.cat([half, -half]).unflatten(-1, (count, 3))
    return Devices(disturbance.shift * normal[..., :2], disturbance.focus_dioptre / 1000 * normal[..., 2])
