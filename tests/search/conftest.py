"""Questions that several tests of the search ask."""

import pytest
import torch

import multilens as ml


@pytest.fixture
def crowded() -> ml.Problem:
    """Three unlike lenses on a notched back with a keep-out: every kind of unknown and of constraint."""
    back = ml.Back(ml.polygon([(0, 0), (30, 0), (30, 12), (14, 12), (14, 30), (0, 30)])).keep_out(
        "flash", ml.disc((7.0, 9.0), 1.5), clearance=0.5
    )
    lenses = [
        ml.Lens(5.0, (0.5, 2.0), (200.0, 3000.0), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3),
        ml.Lens(7.0, (0.5, 3.0), clearance=1.0, disparity_noise=1e-3, blur_noise=2e-3, tiers=2),
        ml.Lens(5.0, (1.0, 1.0), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3, position=(None, 25.0)),
    ]
    return ml.Problem(back, lenses, ml.log_depths(300, 2000, 48), gap=0.25)


@pytest.fixture
def generator() -> torch.Generator:
    return torch.Generator().manual_seed(5)
