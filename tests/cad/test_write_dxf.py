"""The DXF as another program, GDAL, reads it, and as ezdxf audits it."""

import os
import subprocess
import sys
from collections import defaultdict
from math import hypot
from pathlib import Path

import ezdxf
import pytest
import shapely
from pyogrio import set_gdal_config_options
from pyogrio.raw import read as read_with_gdal
from shapely.affinity import scale
from shapely.geometry.base import BaseGeometry

from multilens.cad.export import export
from multilens.cad.write_dxf import COLOURS
from multilens.design import Design

CUT = 1e-4
"""mm; GDAL cuts arcs into edges, asked for as fine as this."""


@pytest.fixture(scope="module")
def path(design: Design, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("dxf") / "layout.dxf"
    export(design, path)
    return path


@pytest.fixture(scope="module")
def seen(path: Path) -> dict[str, list[tuple[BaseGeometry, str]]]:
    """What GDAL sees on each layer: geometry and text."""
    set_gdal_config_options({"OGR_ARC_STEPSIZE": 0.5, "DXF_MERGE_BLOCK_GEOMETRIES": False})
    meta, _, geometries, columns = read_with_gdal(path)
    rows = dict(zip(meta["fields"], columns, strict=True))
    layers = defaultdict(list)
    for geometry, layer, text in zip(geometries, rows["Layer"], rows["Text"], strict=True):
        layers[layer].append((shapely.force_2d(shapely.from_wkb(geometry)), text))
    return layers


def region(lines: list[BaseGeometry]) -> BaseGeometry:
    """Give what an odd number of closed lines encloses, y downwards."""
    whole = shapely.Polygon()
    for line in lines:
        whole = whole.symmetric_difference(shapely.Polygon(line.coords))
    return scale(whole, 1, -1, origin=(0, 0))


def test_another_program_sees_every_layer(seen: dict, design: Design):
    keep_outs = len(design.problem.back.keep_outs)
    counts = {layer: len(things) for layer, things in seen.items()}
    assert counts == {
        "outline": 1,
        "keep-outs": keep_outs + 1,  # one has a hole
        "apertures": 3,
        "bodies": 3,
        "baselines": 3,
        "labels": keep_outs + 3,
    }


def test_another_program_sees_the_back_where_it_is_and_not_mirrored(seen: dict, design: Design):
    back = design.problem.back
    outline = region([line for line, _ in seen["outline"]])
    assert outline.symmetric_difference(back.outline.polygon(256)).area < 0.01
    union = shapely.union_all([keep_out.shape.polygon(256) for keep_out in back.keep_outs])
    assert region([line for line, _ in seen["keep-outs"]]).symmetric_difference(union).area < 0.05


def test_another_program_sees_apertures_and_bodies_as_circles_about_the_lenses(seen: dict, design: Design):
    for layer, grown in (("apertures", 0.0), ("bodies", 1.0)):
        rows = zip(design.layout.position.tolist(), design.layout.aperture_radius.tolist(), seen[layer], strict=True)
        for (x, y), radius, (line, _) in rows:
            distances = [hypot(px - x, py + y) for px, py in line.coords]
            assert distances == pytest.approx([radius + grown] * len(distances), abs=1e-6)


def test_another_program_sees_baselines_between_the_lenses(seen: dict, design: Design):
    longest = max(line.length for line, _ in seen["baselines"])
    assert design.longest_baseline is not None
    assert longest == pytest.approx(design.longest_baseline[0], abs=1e-6)


def test_another_program_reads_the_names(seen: dict):
    assert {text for _, text in seen["labels"]} >= {"flash", "round hexagon", "1", "3"}


def test_nothing_is_to_be_mended(path: Path):
    assert not ezdxf.readfile(path).audit().has_issues


def test_the_file_is_in_millimetres_and_has_its_layers(path: Path):
    document = ezdxf.readfile(path)
    assert document.header["$INSUNITS"] == 4
    assert all(layer in document.layers for layer in COLOURS)


@pytest.mark.parametrize("seed", ["1", "2", "3"])
def test_the_bytes_are_the_same_in_every_process(design: Design, path: Path, tmp_path: Path, seed: str):
    design.save(tmp_path / "design.json")
    program = "import multilens as ml; ml.export(ml.Design.load('design.json'), 'again.dxf')"
    subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, check=True, env={**os.environ, "PYTHONHASHSEED": seed}
    )
    assert (tmp_path / "again.dxf").read_bytes() == path.read_bytes()
