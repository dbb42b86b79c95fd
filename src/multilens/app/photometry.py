"""From what a configuration says of light and texture to a scene and sensors. Nothing here needs torch."""

from multilens.app.refusal import RefusedError, refused_at
from multilens.app.schema import LensConfig, LensesConfig
from multilens.app.schema_cues import CueName, CuesConfig, SceneConfig, SensorConfig
from multilens.scene import Scene
from multilens.sensor import Sensor

PHOTOMETRIC = {CueName["photometric_stereo"], CueName["photometric_defocus"]}
"""The cues that ask for a scene, and for the sensor of every lens."""


def build_scene(config: SceneConfig) -> Scene:
    """Make the scene."""
    with refused_at("scene"):
        return Scene(
            config.contrast,
            config.cycles_per_mm,
            config.light_lux,
            config.exposure_ms,
            config.pixels,
            config.frequency_on.name,
            config.reflectance,
            config.least_snr,
            config.wavelength_nm,
        )


def build_sensor(key: str, config: SensorConfig | None) -> Sensor | None:
    """Make a sensor; None where something of it is unknown."""
    if config is None:
        return None
    if config.full_well is not None and config.snr is not None:
        raise RefusedError(f"{key} must have either full_well or snr, got both")
    if _unknown(config):
        return None
    with refused_at(key):
        make = Sensor.from_snr if config.full_well is None else Sensor
        return make(*(number for number in _numbers(config).values() if number is not None))


def refuse_unknown_sensors(cues: CuesConfig, lenses: LensesConfig) -> None:
    """Refuse lenses of which a photometric cue does not know enough.

    Raises:
        RefusedError: there is one; what is missing is named.
    """
    if not PHOTOMETRIC & set(cues.names):
        return
    kinds: list[tuple[str, LensConfig | None]] = [("lenses.lens", lenses.lens)]
    kinds += [(f"lenses.each.{index}", lens) for index, lens in enumerate(lenses.each or [])]
    for key, lens in kinds:
        if lens is not None and (unknown := _unknown(lens.sensor or SensorConfig())):
            called = "" if lens.name is None else f" ({lens.name})"
            raise RefusedError(
                f"{key}.sensor{called} must be known to a photometric cue, set {', '.join(unknown)}, got null"
            )


def _unknown(config: SensorConfig) -> list[str]:
    """Name what must be known and is not."""
    return [name for name, number in _numbers(config).items() if number is None]


def _numbers(config: SensorConfig) -> dict[str, float | None]:
    """Give what a sensor is made of, in the order it takes them; the ratio stands in for the full well."""
    return {
        "pixel_pitch_um": config.pixel_pitch_um,
        "full_well": config.snr if config.full_well is None else config.full_well,
        "read_noise": config.read_noise,
        "efficiency": config.efficiency,
    }
