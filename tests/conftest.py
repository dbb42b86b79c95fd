"""What all tests share: enforced shapes, one profile of random tests, and the values from outside."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import settings
from jaxtyping import install_import_hook
from shapely import MultiPolygon, Polygon, unary_union

# Every shape in a signature of the package is enforced while tests run. A whole number is welcome where a float is asked for,
# as it is to every type checker.
install_import_hook("multilens", "beartype.beartype(conf=beartype.BeartypeConf(is_pep484_tower=True))")

# Tests run side by side, one to a core: threads of their own would only fight.
torch.set_num_threads(1)

# The same examples on every machine and every run: a failure that is seen once is seen again. The deadline is left to pytest's
# own, since the first example of a test may import half a library.
settings.register_profile("repeatable", derandomize=True, deadline=None, max_examples=30, print_blob=False)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def truths() -> dict[str, Any]:
    """Values from outside this project, with their sources."""
    return json.loads((Path(__file__).parent / "truths.json").read_text())


@pytest.fixture(scope="session")
def random_region() -> Callable[[int], Polygon | MultiPolygon]:
    """Make a valid region of about 100 mm from a seed: several stars joined, others cut out, so with notches, holes and parts."""

    def star(random: np.random.Generator, reach: float, size: float) -> Polygon:
        corners = random.integers(3, 12)
        angle = np.sort(random.uniform(0, 2 * np.pi, corners))
        radius = size * random.uniform(0.3, 1, corners)
        around = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * radius[:, None]
        return Polygon(random.uniform(-reach, reach, 2) + around).buffer(0)

    def region(seed: int) -> Polygon | MultiPolygon:
        random = np.random.default_rng(seed)
        whole = unary_union([star(random, 40, 40) for _ in range(random.integers(1, 4))])
        holes = unary_union([star(random, 30, 12) for _ in range(random.integers(0, 4))])
        left = whole.difference(holes)
        return left if isinstance(left, Polygon | MultiPolygon) and left.area > 1 else region(seed + 1_000_003)

    return region
