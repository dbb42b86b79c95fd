"""What is written is read as it was, within 1e-6 mm, in every format: the same outline, keep-outs, names and clearances."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate, translate

from multilens.back import Back
from multilens.cad.export import export
from multilens.cad.read import read_back
from multilens.design import Design
from multilens.geometry.shape import Shape, disc

FORMATS = ("dxf", "svg", "geojson")
WITHIN = 1e-6
"""mm."""

each_format = pytest.mark.parametrize("form", FORMATS)


def same(one: Shape, other: Shape) -> bool:
    return one.core.hausdorff_distance(other.core) <= WITHIN and abs(one.radius - other.radius) <= WITHIN


@each_format
def test_a_back_comes_back(back: Back, form: str, tmp_path: Path):
    export(back, tmp_path / f"back.{form}")
    again = read_back(tmp_path / f"back.{form}")
    assert same(again.outline, back.outline)
    assert [keep_out.name for keep_out in again.keep_outs] == [keep_out.name for keep_out in back.keep_outs]
    assert [keep_out.clearance for keep_out in again.keep_outs] == [keep_out.clearance for keep_out in back.keep_outs]
    assert all(same(one.shape, other.shape) for one, other in zip(again.keep_outs, back.keep_outs, strict=True))


@each_format
def test_what_has_few_decimals_comes_back_to_the_bit(back: Back, form: str, tmp_path: Path):
    export(back, tmp_path / f"back.{form}")
    assert read_back(tmp_path / f"back.{form}") == back


@each_format
def test_lenses_and_baselines_are_not_taken_for_the_back(design: Design, form: str, tmp_path: Path):
    export(design, tmp_path / f"layout.{form}")
    assert read_back(tmp_path / f"layout.{form}") == design.problem.back


@each_format
@given(seed=st.integers(0, 10_000))
@settings(max_examples=10)
def test_any_region_comes_back(random_region: Callable, tmp_path_factory: pytest.TempPathFactory, form: str, seed: int):
    region = Shape(random_region(seed))
    keep_out = Shape(translate(rotate(random_region(seed + 1), 33), 10.03, -7.01))
    back = (
        Back(region).keep_out("one <&> more", keep_out, clearance=1 / 3).keep_out("disc", disc((1 / 3, -2 / 3), 1 / 7))
    )
    path = tmp_path_factory.mktemp("region") / f"back.{form}"
    export(back, path)
    again = read_back(path)
    assert same(again.outline, back.outline)
    assert again.outline.area == pytest.approx(back.outline.area, abs=WITHIN * 1000)
    assert [keep_out.name for keep_out in again.keep_outs] == ["one <&> more", "disc"]
    assert all(same(one.shape, other.shape) for one, other in zip(again.keep_outs, back.keep_outs, strict=True))


@each_format
def test_the_same_bytes_come_out_twice(design: Design, form: str, tmp_path: Path):
    for name in ("one", "two"):
        export(design, tmp_path / f"{name}.{form}")
    assert (tmp_path / f"one.{form}").read_bytes() == (tmp_path / f"two.{form}").read_bytes()
