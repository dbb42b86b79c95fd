"""Scenes: the range of each number."""

import pytest

from multilens import Scene

ROOM = {"contrast": 0.3, "cycles_per_mm": 40.0, "light_lux": 300.0, "exposure_ms": 30.0, "pixels": 200}


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("contrast", 1.1, "contrast must be > 0 and <= 1, got 1.1"),
        ("cycles_per_mm", 0.0, "cycles_per_mm must be > 0 and finite, got 0"),
        ("light_lux", -1.0, "light_lux must be > 0 and finite, got -1"),
        ("exposure_ms", 0.0, "exposure_ms must be > 0 and finite, got 0"),
        ("pixels", 0, "pixels must be a whole number >= 1, got 0"),
        ("frequency_on", "retina", "frequency_on must be one of sensor, object, got 'retina'"),
        ("reflectance", 0.0, "reflectance must be > 0 and <= 1, got 0"),
        ("least_snr", 0.0, "least_snr must be > 0 and finite, got 0"),
        ("wavelength_nm", 0.0, "wavelength_nm must be > 0 and finite, got 0"),
    ],
)
def test_a_value_out_of_its_range_is_refused_by_name(key, value, message):
    with pytest.raises(ValueError, match=message):
        Scene(**ROOM | {key: value})
