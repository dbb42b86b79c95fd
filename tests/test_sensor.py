"""Sensors: the range of each number, and the full well behind a signal-to-noise ratio."""

from math import inf, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens import Sensor

PHONE = {"pixel_pitch_um": 1.22, "full_well": 6000.0, "read_noise": 2.0, "efficiency": 0.5}


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("pixel_pitch_um", 0.0, "pixel_pitch_um must be > 0 and finite, got 0"),
        ("full_well", inf, "full_well must be > 0 and finite, got inf"),
        ("read_noise", -1.0, "read_noise must be >= 0 and finite, got -1"),
        ("efficiency", 1.5, "efficiency must be > 0 and <= 1, got 1.5"),
    ],
)
def test_a_number_out_of_its_range_is_refused_by_name(key, value, message):
    with pytest.raises(ValueError, match=message):
        Sensor(**PHONE | {key: value})


@given(st.floats(1.0, 1e3), st.floats(0.0, 100.0))
def test_a_sensor_by_its_ratio_of_signal_to_noise_has_that_ratio(snr, read_noise):
    sensor = Sensor.from_snr(1.22, snr, read_noise, 0.5)
    assert sensor.full_well / sqrt(sensor.full_well + read_noise**2) == pytest.approx(snr, rel=1e-12)


def test_a_ratio_out_of_its_range_is_refused_by_name():
    with pytest.raises(ValueError, match="snr must be > 0 and finite, got 0"):
        Sensor.from_snr(1.22, 0.0, 2.0, 0.5)


def test_two_pixels_make_one_cycle_at_the_highest_frequency():
    sensor = Sensor(**PHONE)
    assert sensor.nyquist * 2 * sensor.pixel_pitch_um / 1000 == pytest.approx(1)
