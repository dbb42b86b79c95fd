"""What a configuration may hold of cues: which, when they fail, by what texture and light, on what sensor."""

from dataclasses import dataclass, field
from enum import Enum

from omegaconf import MISSING

CueName = Enum(
    "CueName",
    ["stereo", "defocus", "limited_stereo", "photometric_stereo", "photometric_defocus", "printed_defocus"],
)
"""The cues that a configuration can name."""

FrequencyOn = Enum("FrequencyOn", ["sensor", "object"])
"""Where a spatial frequency may be counted."""


@dataclass
class SensorConfig:
    """What stands behind a lens, as `multilens.sensor.Sensor` tells; null where unknown, which a photometric cue refuses.

    Args:
        pixel_pitch_um: um.
        full_well: electrons; or snr instead.
        snr: signal-to-noise ratio of a full pixel; or full_well instead.
        read_noise: electrons.
        efficiency: photoelectrons per photon.
    """

    pixel_pitch_um: float | None = None
    full_well: float | None = None
    snr: float | None = None
    read_noise: float | None = None
    efficiency: float | None = None


@dataclass
class SceneConfig:
    """The texture by which depth is read, and its light; what each field means is told by `multilens.scene.Scene`.

    Args:
        contrast: amplitude over mean.
        cycles_per_mm: spatial frequency.
        frequency_on: sensor or object.
        light_lux: lux.
        exposure_ms: the longest, ms.
        pixels: read together.
        reflectance: of the object.
        least_snr: of the texture's amplitude.
        wavelength_nm: nm.
    """

    contrast: float = MISSING
    cycles_per_mm: float = MISSING
    frequency_on: FrequencyOn = FrequencyOn["sensor"]
    light_lux: float = MISSING
    exposure_ms: float = MISSING
    pixels: int = MISSING
    reflectance: float = 0.18
    least_snr: float = 3.0
    wavelength_nm: float = 555.0


@dataclass
class PairLimitsConfig:
    """When two lenses may measure depth together, beside what the lenses themselves cannot do.

    Args:
        max_disparity: largest shift that a matcher finds, mm on the sensor of the longer lens; null for any.
        least_overlap: part of the narrower field of view that both lenses must see.
    """

    max_disparity: float | None = None
    least_overlap: float = 0.0


@dataclass
class TwoImagesConfig:
    """The two images of photometric_defocus.

    Args:
        power_change_dioptres: by how much they differ in optical power, 1/m; null without the cue.
        light_share: part of the light that each gets.
        frequency_error: relative error of the texture's frequency.
    """

    power_change_dioptres: float | None = None
    light_share: float = 1.0
    frequency_error: float = 0.0


@dataclass
class RelativeErrorsConfig:
    """The relative errors of printed_defocus.

    Args:
        frequency: of the texture's frequency.
        amplitude: of its amplitude.
        change: of the change of its amplitude with focus; null without the cue.
    """

    frequency: float = 0.0
    amplitude: float = 0.0
    change: float | None = None


@dataclass
class CuesConfig:
    """Ways to measure depth.

    Args:
        names: at least one.
        limits: of the pairs of limited_stereo and photometric_stereo.
        two_images: of photometric_defocus.
        relative_errors: of printed_defocus.
    """

    names: list[CueName] = MISSING
    limits: PairLimitsConfig = field(default_factory=PairLimitsConfig)
    two_images: TwoImagesConfig = field(default_factory=TwoImagesConfig)
    relative_errors: RelativeErrorsConfig = field(default_factory=RelativeErrorsConfig)
