"""A search as a moving picture."""

from io import BytesIO

import numpy as np
import pytest
import torch
from PIL import Image

import multilens as ml
from multilens.plot import animation
from multilens.plot.animation import animated_search
from multilens.plot.style import lens_colour

FOUND = ml.Layout([[8, 8], [32, 32]], [2, 2], [800, 900])


@pytest.fixture(scope="module")
def problem() -> ml.Problem:
    lens = ml.Lens(5.0, (1.0, 3.0), (200, 2000), clearance=1.0, disparity_noise=1e-3, blur_noise=1e-3)
    return ml.Problem(ml.Back.rectangle(40, 40), [lens] * 2, ml.log_depths(300, 2000, 24))


def drawn(problem: ml.Problem) -> bytes:
    # Two starts in three steps.
    position = torch.linspace(5, 35, 2 * 3 * 2 * 2, dtype=torch.float64).reshape(2, 3, 2, 2)
    layouts = ml.Layout(position, torch.full((2, 3, 2), 2.0), torch.full((2, 3, 2, 1), 700.0))
    return animated_search(problem, layouts, problem.score(layouts), 1, FOUND)


@pytest.fixture(scope="module")
def film(problem: ml.Problem) -> bytes:
    return drawn(problem)


def test_there_is_a_picture_of_every_step_and_of_the_design(film: bytes):
    image = Image.open(BytesIO(film))
    durations = []
    for frame in range(image.n_frames):
        image.seek(frame)
        durations.append(image.info["duration"])
    assert durations == [animation.FIRST, animation.EACH, animation.EACH, animation.LAST]
    assert image.size == tuple(round(inches * animation.DOTS_PER_INCH) for inches in animation.SIZE)
    assert image.info["loop"] == 0


def test_the_same_input_gives_the_same_bytes(problem: ml.Problem, film: bytes):
    assert drawn(problem) == film


def test_the_lenses_keep_their_colours(film: bytes):
    image = Image.open(BytesIO(film))
    image.seek(image.n_frames - 1)
    pixels = np.asarray(image.convert("RGB")).reshape(-1, 3).astype(int)
    for lens in range(2):
        wanted = [int(lens_colour(lens)[i : i + 2], 16) for i in (1, 3, 5)]
        assert (abs(pixels - wanted).max(-1) <= 8).sum() > 20


def test_it_is_told_how_far_the_drawing_has_come(problem: ml.Problem):
    told = []
    layouts = ml.Layout(torch.full((1, 1, 2, 2), 9.0), torch.full((1, 1, 2), 2.0), torch.full((1, 1, 2, 1), 700.0))
    animated_search(problem, layouts, problem.score(layouts), 0, FOUND, lambda *given: told.append(given))
    assert told == [(0, 2), (1, 2)]
