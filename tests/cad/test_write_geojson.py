import json
from dataclasses import replace
from pathlib import Path

import pytest
import shapely
from pyogrio.raw import read as read_with_gdal

from multilens.cad.export import export
from multilens.design import Design
from multilens.problem import Problem


@pytest.fixture
def path(design: Design, tmp_path: Path) -> Path:
    export(design, tmp_path / "layout.geojson")
    return tmp_path / "layout.geojson"


def test_another_program_sees_the_areas_with_y_upwards(path: Path, design: Design):
    meta, _, geometries, columns = read_with_gdal(path)
    rows = dict(zip(meta["fields"], columns, strict=True))
    seen = {
        (layer, name): shapely.from_wkb(wkb)
        for layer, name, wkb in zip(rows["layer"], rows["name"], geometries, strict=True)
    }
    back = design.problem.back
    assert seen["outline", "outline"].area == pytest.approx(back.outline.area, rel=1e-4)
    for keep_out in back.keep_outs:
        left, top, right, bottom = keep_out.shape.bounds
        assert seen["keep-outs", keep_out.name].bounds == pytest.approx((left, -bottom, right, -top), abs=2e-3)
    for (x, y), number in zip(design.layout.position.tolist(), (1, 2, 3), strict=True):
        middle = seen["apertures", f"lens {number}"].centroid
        assert (middle.x, middle.y) == pytest.approx((x, -y), abs=1e-6)


def test_what_a_lens_is_stands_in_its_properties(path: Path, design: Design):
    features = json.loads(path.read_text())["features"]
    (first,) = (f for f in features if f["properties"]["layer"] == "apertures" and f["properties"]["name"] == "lens 1")
    facts = first["properties"]
    assert facts["radius"] == design.layout.aperture_radius[0].item()
    assert facts["focus"] == list(design.foci[0])
    assert facts["f_number"] == design.f_numbers[0]


def test_the_name_of_a_lens_stands_behind_its_number(design: Design, tmp_path: Path):
    lenses = [
        replace(lens, name=name) for lens, name in zip(design.problem.lenses, ["main", None, "tele"], strict=True)
    ]
    named = replace(design, problem=Problem(design.problem.back, lenses, [300.0, 900.0]))
    export(named, tmp_path / "layout.geojson")
    features = json.loads((tmp_path / "layout.geojson").read_text())["features"]
    assert {"lens 1 (main)", "lens 2", "lens 3 (tele)"} <= {feature["properties"]["name"] for feature in features}
