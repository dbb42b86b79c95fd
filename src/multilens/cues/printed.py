"""Defocus by equation 8.1 as the thesis prints it, each relative error one number for all depths."""

from collections.abc import Sequence
from dataclasses import dataclass

from jaxtyping import Float
from torch import Tensor

from multilens.cues.cue import Measurement
from multilens.cues.thesis import LensDefocus
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.optics.photometric import printed_defocus_error
from multilens.ranges import refuse_unless_not_negative, refuse_unless_positive


@dataclass(frozen=True)
class PrintedDefocus:
    """Differential defocus of every lens and tier: err = Z abs(Z - Zf) / Zf sqrt(4 (e_w/w)^2 + (e_B/B)^2 + (e_Bf/Bf)^2).

    It knows neither the aperture nor the focal length of a lens, and has no error in focus.

    Args:
        frequency_error: e_w/w, relative error of the texture's frequency, >= 0.
        amplitude_error: e_B/B, of its amplitude, >= 0.
        change_error: e_Bf/Bf, of the change of its amplitude with focus, > 0.

    Raises:
        ValueError: a number is out of its range.

    Reference:
        Thesis, equation 8.1; E. Alexander, A theory of depth from differential defocus (2019).
    """

    frequency_error: float
    amplitude_error: float
    change_error: float

    def __post_init__(self) -> None:
        refuse_unless_not_negative("frequency_error", self.frequency_error)
        refuse_unless_not_negative("amplitude_error", self.amplitude_error)
        refuse_unless_positive("change_error", self.change_error)

    def measurements(self, lenses: Sequence[Lens]) -> tuple[Measurement, ...]:
        """Name the lenses, and their tiers where a lens has several."""
        return LensDefocus().measurements(lenses)

    def __call__(
        self, layout: Layout, lenses: Sequence[Lens], depths: Float[Tensor, " z"]
    ) -> Float[Tensor, "*batch k z"]:
        """Give the depth error of every lens and tier, mm; it is zero where the depth is in focus."""
        _, focus = LensDefocus().slope_and_focus(layout, lenses)
        errors = (self.frequency_error, self.amplitude_error, self.change_error)
        return printed_defocus_error(depths, focus.unsqueeze(-1), *errors)
