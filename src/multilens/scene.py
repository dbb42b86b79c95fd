"""A scene: the texture by which depth is read, its light, and how the images are read."""

from dataclasses import dataclass

from multilens.ranges import refuse_unless_positive, refuse_unless_share

PLACES = ("sensor", "object")
"""Where a spatial frequency may be counted."""


@dataclass(frozen=True)
class Scene:
    """One texture in one light: a sinusoid of this contrast and frequency, everywhere and at every depth.

    Args:
        contrast: amplitude of the sinusoid over its mean, > 0 and <= 1.
        cycles_per_mm: its spatial frequency, > 0.
        frequency_on: "sensor" counts cycles on a mm of sensor, alike at all depths (a texture with detail of every size, read
            in a fixed band); "object" on a mm of the object, so that the image is the finer the farther away it is.
        light_lux: illuminance of the object, lux, > 0.
        exposure_ms: longest exposure; it is shortened where the pixels would be full before, ms, > 0.
        pixels: how many are read together for one depth, >= 1.
        reflectance: part of the light that the object scatters back, evenly to all sides, > 0 and <= 1; 0.18 is mid grey.
        least_snr: amplitude of the texture over the error of that amplitude below which the texture counts as lost, > 0.
        wavelength_nm: of the light, nm, > 0; 555 is where the eye sees best and the lumen is defined.

    Raises:
        ValueError: a number is out of its range, or a word is not one of these.
    """

    contrast: float
    cycles_per_mm: float
    light_lux: float
    exposure_ms: float
    pixels: int
    frequency_on: str = "sensor"
    reflectance: float = 0.18
    least_snr: float = 3.0
    wavelength_nm: float = 555.0

    def __post_init__(self) -> None:
        refuse_unless_share("contrast", self.contrast)
        for name in ("cycles_per_mm", "light_lux", "exposure_ms", "least_snr", "wavelength_nm"):
            refuse_unless_positive(name, getattr(self, name))
        if not isinstance(self.pixels, int) or self.pixels < 1:
            raise ValueError(f"pixels must be a whole number >= 1, got {self.pixels}")
        if self.frequency_on not in PLACES:
            raise ValueError(f"frequency_on must be one of {', '.join(PLACES)}, got {self.frequency_on!r}")
        refuse_unless_share("reflectance", self.reflectance)

    @property
    def wavelength(self) -> float:
        """Of the light, mm."""
        return self.wavelength_nm / 1e6
