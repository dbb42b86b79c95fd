"""Scenes and sensors from a configuration, and what is said where something is unknown."""

import pytest

from multilens.app.photometry import build_scene, build_sensor, refuse_unknown_sensors
from multilens.app.refusal import RefusedError
from multilens.app.schema import LensConfig, LensesConfig
from multilens.app.schema_cues import CueName, CuesConfig, FrequencyOn, SceneConfig, SensorConfig
from multilens.scene import Scene
from multilens.sensor import Sensor

WHOLE = SensorConfig(pixel_pitch_um=1.22, full_well=5060, read_noise=3, efficiency=0.5)
PHOTOMETRIC = CuesConfig([CueName["photometric_stereo"]])


def test_a_scene_is_what_the_configuration_says():
    config = SceneConfig(0.2, 0.5, FrequencyOn["object"], 500, 33.3, 1089, 0.9, 5.0, 600.0)
    assert build_scene(config) == Scene(0.2, 0.5, 500, 33.3, 1089, "object", 0.9, 5.0, 600.0)


def test_what_is_wrong_with_a_scene_is_refused_by_its_key():
    with pytest.raises(RefusedError, match=r"^scene: contrast must be > 0 and <= 1, got 2$"):
        build_scene(SceneConfig(2.0, 50, FrequencyOn["sensor"], 500, 33.3, 1089))


def test_a_sensor_is_what_the_configuration_says():
    assert build_sensor("lens.sensor", WHOLE) == Sensor(1.22, 5060, 3, 0.5)


def test_a_sensor_may_be_told_by_its_ratio_of_signal_to_noise():
    by_ratio = SensorConfig(pixel_pitch_um=1.22, snr=70.0, read_noise=3, efficiency=0.5)
    assert build_sensor("lens.sensor", by_ratio) == Sensor.from_snr(1.22, 70.0, 3, 0.5)


def test_both_full_well_and_ratio_are_one_too_many():
    both = SensorConfig(pixel_pitch_um=1.22, full_well=5060, snr=70.0, read_noise=3, efficiency=0.5)
    with pytest.raises(RefusedError, match=r"^lens.sensor must have either full_well or snr, got both$"):
        build_sensor("lens.sensor", both)


@pytest.mark.parametrize("well", ["full_well", "snr"])
def test_a_sensor_that_holds_no_light_is_refused_rather_than_unknown(well):
    with pytest.raises(RefusedError, match=f"^lens.sensor: {well} must be > 0 and finite, got 0$"):
        build_sensor("lens.sensor", SensorConfig(pixel_pitch_um=1.22, read_noise=3, efficiency=0.5, **{well: 0.0}))


@pytest.mark.parametrize("config", [None, SensorConfig(pixel_pitch_um=1.22)])
def test_a_sensor_of_which_something_is_unknown_is_unknown(config):
    assert build_sensor("lens.sensor", config) is None


def test_what_is_wrong_with_a_sensor_is_refused_by_its_key():
    with pytest.raises(RefusedError, match=r"^lens.sensor: efficiency must be > 0 and <= 1, got 5$"):
        build_sensor("lens.sensor", SensorConfig(1.22, 5060, None, 3, 5.0))


def test_a_photometric_cue_asks_for_what_is_missing_by_name():
    lenses = LensesConfig(each=[LensConfig(sensor=WHOLE), LensConfig(name="tele", sensor=SensorConfig(1.12))])
    with pytest.raises(
        RefusedError,
        match=r"^lenses.each.1.sensor \(tele\) must be known to a photometric cue, set full_well, read_noise, efficiency, ",
    ):
        refuse_unknown_sensors(PHOTOMETRIC, lenses)


def test_other_cues_ask_for_no_sensor():
    refuse_unknown_sensors(CuesConfig([CueName["stereo"]]), LensesConfig(count=2, lens=LensConfig()))


def test_lenses_with_known_sensors_pass():
    refuse_unknown_sensors(PHOTOMETRIC, LensesConfig(count=2, lens=LensConfig(sensor=WHOLE)))
