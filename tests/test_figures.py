"""The figures of the pages are those that docs/figures.py draws."""

import re
from importlib.util import module_from_spec, spec_from_file_location
from io import BytesIO
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from PIL import Image

DOCS = Path(__file__).parents[1] / "docs"

UNSEARCHED = ("cues", "room")
"""Figures of layouts that are given; the others take seconds of search each."""


@pytest.fixture(scope="module")
def figures() -> ModuleType:
    spec = spec_from_file_location("docs_figures", DOCS / "figures.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_figure_is_on_a_page(figures: ModuleType):
    shown = {
        name for page in DOCS.glob("*.md") for name in re.findall(r"\]\(images/(\w+)\.png\)", page.read_text("utf-8"))
    }
    assert {draw.__name__ for draw in figures.FIGURES} <= shown


@pytest.mark.parametrize("name", UNSEARCHED)
def test_a_picture_is_what_is_drawn_now(figures: ModuleType, name: str):
    drawn, stored = (
        np.asarray(Image.open(source).convert("RGB"), dtype=float)
        for source in (BytesIO(figures.png(getattr(figures, name)())), DOCS / "images" / f"{name}.png")
    )
    assert drawn.shape == stored.shape
    # Fonts are drawn a little otherwise by other versions; a line or a label elsewhere changes far more than 1 of 255.
    assert np.abs(drawn - stored).mean() < 1
