"""Samples of devices, against the distribution they are drawn from."""

from typing import Any

import pytest
import torch

from multilens import Layout
from multilens.cues.drift import Drift
from multilens.disturbance import Disturbance, draw_devices

BOTH = Disturbance(shift=0.1, focus_dioptre=0.02)


def test_devices_are_mirrored_so_that_their_mean_is_what_was_drawn():
    devices = draw_devices(BOTH, count=3, samples=8, seed=0)
    torch.testing.assert_close(devices.shift.mean(0), torch.zeros(3, 2).double(), atol=1e-15, rtol=0)
    torch.testing.assert_close(devices.vergence.mean(0), torch.zeros(3).double(), atol=1e-18, rtol=0)


def test_devices_have_the_asked_for_spread_and_are_independent():
    devices = draw_devices(BOTH, count=2, samples=4096, seed=1)
    every = torch.cat([devices.shift.flatten(1) / 0.1, devices.vergence / 2e-5], dim=-1)
    # 4096 evenly spread numbers have the variance of a normal one to 1 %.
    torch.testing.assert_close(torch.cov(every.T), torch.eye(6).double(), atol=0.02, rtol=0)


def test_the_same_seed_gives_the_same_devices():
    first, second = (draw_devices(BOTH, 2, 4, seed=5) for _ in range(2))
    assert torch.equal(first.shift, second.shift)
    assert not torch.equal(first.shift, draw_devices(BOTH, 2, 4, seed=6).shift)


def test_devices_that_do_not_vary_are_one():
    assert len(draw_devices(Disturbance(covered=1.0, drift=Drift(shift=0.1)), 3, 64, 0).shift) == 1


def test_a_device_is_built_off_its_layout_by_its_own_shift_and_vergence():
    layout = Layout([[0.0, 0.0], [10.0, 0.0]], [1.0, 2.0], [[1000.0, 500.0], [2000.0, 2000.0]])
    devices = draw_devices(BOTH, 2, 4, 0)
    built = devices.built(layout)
    assert built.position.shape == (4, 2, 2)
    torch.testing.assert_close(built.position[1] - layout.position, devices.shift[1])
    # All tiers of a lens are off by the same vergence.
    off = 1 / built.focus - 1 / layout.focus
    torch.testing.assert_close(off, devices.vergence.unsqueeze(-1).expand(-1, -1, 2))
    assert torch.equal(built.aperture_radius[3], layout.aperture_radius)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"shift": -0.1}, "shift must be >= 0 and finite, got -0.1"),
        ({"focus_dioptre": float("inf")}, "focus_dioptre must be >= 0 and finite, got inf"),
        ({"covered": 1.5}, "covered must be from 0 to 1, got 1.5"),
    ],
)
def test_a_disturbance_that_makes_no_sense_is_refused(given: dict[str, Any], message: str):
    with pytest.raises(ValueError, match=message):
        Disturbance(**given)
