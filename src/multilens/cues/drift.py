"""Any cue by cameras that have moved since they were calibrated: what nobody knows adds to every error."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.cues.cue import Cue, FusedCue, LimitedCue, Measurement
from multilens.cues.thesis import NANOMETRE
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.drift import direction_drift, focus_drift_error, pair_drift_error
from multilens.ranges import refuse_unless_not_negative

LEAST_INFORMATION = 1e-30
"""1/mm^2: an error of a billion kilometres."""


@dataclass(frozen=True)
class Drift:
    """How far cameras move after their calibration; each number is a standard deviation, >= 0, independent for every lens.

    Args:
        shift: of a camera, lens and sensor together, along x and along y, mm.
        decentre_um: of a lens over its own sensor, along x and along y, um.
        focus_dioptre: of one over the in-focus depth, dioptres.

    Raises:
        ValueError: a number is out of its range.
    """

    shift: float = 0.0
    decentre_um: float = 0.0
    focus_dioptre: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            refuse_unless_not_negative(name, value)

    def pair_error(
        self, pair: tuple[Lens, Lens], baseline: Float[Tensor, "*batch"], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch z"]:
        """Give the standard deviation of the depth that a pair reads, mm."""
        shift, decentre = (depths.new_tensor(number) for number in (self.shift, self.decentre_um / 1000))
        first, second = (
            direction_drift(depths, depths.new_tensor(lens.focal_length), shift, decentre) for lens in pair
        )
        return pair_drift_error(depths, baseline.clamp(min=NANOMETRE).unsqueeze(-1), first, second)

    def focus_error(self, depths: Float[Tensor, " z"]) -> Float[Tensor, " z"]:
        """Give the standard deviation of the depth that the defocus of one lens reads, mm."""
        return focus_drift_error(depths, depths.new_tensor(self.focus_dioptre / 1000))


@dataclass(frozen=True)
class Drifted:
    """A cue whose errors have those of a drift added in quadrature: err = sqrt(err_cue^2 + err_drift^2).

    What is measured by two lenses suffers from their shift and decentre, what is measured by one from its focus. Where the device
    trusts its best measurement it goes by these errors, which are all that it can know.

    Args:
        cue: of cameras as they were calibrated.
        drift: since then.
    """

    cue: Cue
    drift: Drift

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name what the cue measures."""
        return self.cue.measurements(lenses)

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every measurement, mm."""
        return self._with_drift(self.cue(layout, lenses, depths), layout, lenses, depths)

    def information(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"], smooth: bool = False
    ) -> Float[Tensor, "*batch z"]:
        """Give what all measurements tell together, 1/mm^2: what the cue tells, times the part that the drift leaves of their sum.

        With equal lenses the drift takes the same part of what every pair tells, so that this is exact for many views of one
        point; with unequal lenses it is a mean of the pairs' parts.
        """
        ask = self.cue.smooth if smooth and isinstance(self.cue, LimitedCue) else self.cue
        errors = ask(layout, lenses, depths).clamp(min=NANOMETRE)
        left = self._with_drift(errors, layout, lenses, depths).square().reciprocal().sum(-2)
        if not isinstance(self.cue, FusedCue):
            return left
        # Where nothing measures both sums are 0, and so is what the cue tells.
        alone = errors.square().reciprocal().sum(-2).clamp(min=LEAST_INFORMATION)
        return self.cue.information(layout, lenses, depths, smooth) * (left / alone)

    def _with_drift(self, errors: Tensor, layout: Layout, lenses: Sequence[Lens], depths: Tensor) -> Tensor:
        rows = []
        for row, measurement in zip(errors.unbind(-2), self.measurements(lenses), strict=True):
            added = self._added(measurement, layout, lenses, depths)
            rows.append(row if added is None else _quadrature(row, added))
        return torch.stack(rows, dim=-2) if rows else errors

    def _added(self, measurement: Measurement, layout: Layout, lenses: Sequence[Lens], depths: Tensor) -> Tensor | None:
        """Give the error that the drift adds to a measurement; None for none, so that a perfect focus keeps its gradient."""
        if len(measurement.lenses) == 1:
            return self.drift.focus_error(depths) if self.drift.focus_dioptre else None
        if not (self.drift.shift or self.drift.decentre_um):
            return None
        first, second = measurement.lenses
        baseline = (layout.position[..., first, :] - layout.position[..., second, :]).norm(dim=-1)
        return self.drift.pair_error((lenses[first], lenses[second]), baseline, depths)


@dataclass(frozen=True)
class DriftedLimited(Drifted):
    """The same of a cue that fails at some depths."""

    cue: LimitedCue

    def smooth(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give errors that are finite and never less than those of `__call__`."""
        return self._with_drift(self.cue.smooth(layout, lenses, depths), layout, lenses, depths)


def drifted(cue: Cue, drift: Drift) -> Cue:
    """Give a cue by cameras that drifted: the cue itself where nothing drifts."""
    if drift == Drift():
        return cue
    return DriftedLimited(cue, drift) if isinstance(cue, LimitedCue) else Drifted(cue, drift)


def _quadrature(error: Tensor, added: Tensor) -> Tensor:
    # Where a measurement fails, an infinite error under a root would make the gradient NaN.
    finite = error.where(error.isfinite(), 0)
    return torch.where(error.isfinite(), (finite.square() + added.square()).sqrt(), error)
