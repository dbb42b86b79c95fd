"""A sensor: what turns light into numbers, and how noisy they are."""

from dataclasses import dataclass
from math import sqrt

from multilens.ranges import refuse_unless_not_negative, refuse_unless_positive, refuse_unless_share


@dataclass(frozen=True)
class Sensor:
    """What is known of the sensor behind a lens.

    Args:
        pixel_pitch_um: from pixel to pixel, um, > 0.
        full_well: photoelectrons that a pixel holds at most, > 0.
        read_noise: standard deviation of a pixel read in the dark, electrons, >= 0.
        efficiency: photoelectrons for each photon that reaches the lens within the pixel's share of the light: glass, colour
            filter and silicon together, > 0 and <= 1.

    Raises:
        ValueError: a number is out of its range.
    """

    pixel_pitch_um: float
    full_well: float
    read_noise: float
    efficiency: float

    def __post_init__(self) -> None:
        refuse_unless_positive("pixel_pitch_um", self.pixel_pitch_um)
        refuse_unless_positive("full_well", self.full_well)
        refuse_unless_not_negative("read_noise", self.read_noise)
        refuse_unless_share("efficiency", self.efficiency)

    @classmethod
    def from_snr(cls, pixel_pitch_um: float, snr: float, read_noise: float, efficiency: float) -> "Sensor":
        """Make a sensor of which the signal-to-noise ratio of a full pixel is known in place of its full well W.

        The shot noise of W electrons is sqrt(W), so snr = W / sqrt(W + read_noise^2), solved for W.

        Args:
            pixel_pitch_um: um, > 0.
            snr: of one full pixel in one exposure, a ratio (of 40 dB it is 100), > 0.
            read_noise: electrons, >= 0.
            efficiency: > 0 and <= 1.

        Raises:
            ValueError: a number is out of its range.
        """
        refuse_unless_positive("snr", snr)
        refuse_unless_not_negative("read_noise", read_noise)
        full_well = snr * (snr + sqrt(snr**2 + 4 * read_noise**2)) / 2
        return cls(pixel_pitch_um, full_well, read_noise, efficiency)

    @property
    def pixel_pitch(self) -> float:
        """From pixel to pixel, mm."""
        return self.pixel_pitch_um / 1000

    @property
    def nyquist(self) -> float:
        """Highest spatial frequency that the pixels can tell from a lower one, cycles per mm of sensor."""
        return 1 / (2 * self.pixel_pitch)
