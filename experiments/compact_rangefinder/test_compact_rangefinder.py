"""The study's result still holds: its law of the baseline, noisy images, what it needs, and its ranges found again."""

import csv
from math import exp, pi
from pathlib import Path
from types import ModuleType

import pytest
import torch

STUDY = Path(__file__).parent

MODULES = ("rangefinder", "needs")
"""Of the study, in the order of their imports."""


def table(name: str) -> list[dict[str, str]]:
    with (STUDY / "results" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_baseline_that_stereo_needs_is_proportional_to_its_worst_error(study: dict[str, ModuleType]) -> None:
    # The error of stereo falls as one over the baseline, and nothing else depends on it.
    device = study["rangefinder"].Rangefinder()
    # 1 cm / sqrt(2 / pi), by hand.
    needed = 4 * device.errors("stereo").max().item() / 12.533
    row = next(row for row in table("needs") if row["number"] == "baseline (mm)")
    assert row["stereo needs"] == f"{needed:.3g} or more"


def test_a_need_is_an_edge(study: dict[str, ModuleType]) -> None:
    needs, device = study["needs"], study["rangefinder"].Rangefinder()
    number = needs.Number("baseline", "baseline (mm)", 2.0, 8.0, "near the edge, for a quick look")
    ((low, high),) = needs.needed(device, number, "stereo")
    assert high == pytest.approx(8)
    changed = study["rangefinder"].changed
    assert changed(device, "baseline", low * 1.001).covers("stereo")
    assert not changed(device, "baseline", low * 0.999).covers("stereo")


def test_defocus_between_two_lenses_is_mirrored_by_their_exchange(study: dict[str, ModuleType]) -> None:
    device = study["rangefinder"].Rangefinder(power_change=1.36)
    other = study["rangefinder"].Rangefinder(power_change=-1.36)
    assert other.foci == device.foci[::-1]
    assert torch.allclose(device.errors("defocus"), other.errors("defocus"), rtol=1e-9)


def test_stereo_and_defocus_of_the_same_two_noisy_images_are_independent() -> None:
    # Two images of a sinusoid with its own blur and phase in each, 20,000 draws; depth by phase and by the ratio of amplitudes.
    baseline, focal_length, spread, w, contrast, noise, pixels = 0.9, 12.0, 0.75, 2 * pi * 25, 0.3, 0.03, 400
    depth, foci = 600.0, (1 / 450, 1 / 650)
    random = torch.Generator().manual_seed(0)
    phase = torch.arange(pixels, dtype=torch.float64) * (2 * pi * 10 / pixels)
    waves = torch.exp(-1j * phase) * (2 / pixels)
    seen = []
    for lens, focus in enumerate(foci):
        amplitude = contrast * exp(-((w * focal_length * spread * (1 / depth - focus)) ** 2) / 2)
        shift = lens * w * focal_length * baseline / depth
        pictures = noise * torch.randn(20_000, pixels, dtype=torch.float64, generator=random)
        pictures += amplitude * torch.cos(phase + shift)
        seen.append(pictures.to(torch.complex128) @ waves)
    # Both are linear in 1/Z to first order.
    by_phase = (seen[1] * seen[0].conj()).angle() / (w * focal_length * baseline)
    by_amplitude = (seen[1].abs() / seen[0].abs()).log() / ((w * focal_length * spread) ** 2 * (foci[1] - foci[0]))
    correlation = torch.corrcoef(torch.stack([by_phase, by_amplitude]))[0, 1].item()
    # Its own standard deviation is 0.007.
    assert abs(correlation) < 0.03


def test_defocus_is_worth_the_same_baseline_at_every_depth(study: dict[str, ModuleType]) -> None:
    device = study["rangefinder"].Rangefinder(power_change=0.6, periods=(16,), aperture_radius=1.0)
    stereo, defocus = device.errors("stereo"), device.errors("defocus")
    seen = stereo.isfinite()
    assert seen.sum() > 50
    # w S^2 dP: 2 pi * 31.25 * 12, a spread of 0.5 mm, 0.0006 per mm.
    assert torch.allclose((4 * stereo / defocus)[seen], torch.tensor(0.35343, dtype=torch.float64), rtol=1e-4)


def test_the_ranges_are_found_again(study: dict[str, ModuleType]) -> None:
    row = next(
        row for row in table("ranges") if row["texture of"] == "one size" and row["difference (dioptres)"] == "0.2"
    )
    device = study["rangefinder"].Rangefinder(periods=study["rangefinder"].OFFICE)
    for way in ("stereo", "defocus"):
        ((near, far),) = device.working_range(way).intervals
        assert row[f"{way} (m)"] == f"{near / 1000:.3g} to {far / 1000:.3g}"


def test_the_preset_in_an_office_covers_what_is_published_by_stereo_and_not_by_defocus(
    study: dict[str, ModuleType],
) -> None:
    device = study["rangefinder"].Rangefinder()
    assert [device.covers(way) for way in study["rangefinder"].WAYS] == [True, False, True]
