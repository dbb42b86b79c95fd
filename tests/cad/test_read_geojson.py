import json
from typing import Any

import pytest
import shapely
from shapely.geometry import box, mapping

from multilens.back import Back
from multilens.cad.drawing import Wanted, back_of
from multilens.cad.plan import Plan
from multilens.cad.read_geojson import read_geojson
from multilens.cad.write_geojson import write_geojson
from multilens.geometry.shape import disc, rectangle

SQUARE = mapping(box(0, 0, 40, 50))


def feature(geometry: Any, **properties: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def collection(*features: Any, **more: Any) -> str:
    return json.dumps({"type": "FeatureCollection", "features": features} | more)


def read(text: str, units: str | None = "mm", **wanted: object) -> Back:
    return back_of(read_geojson(text, units), Wanted(**wanted)).back


def test_a_bare_geometry_is_the_outline_and_y_turns_over():
    assert read(json.dumps(SQUARE)) == Back(rectangle(40, 50, centre=(20, -25)))


def test_features_are_asked_for_by_layer_or_by_name():
    text = collection(
        feature(SQUARE, Layer="HOUSING"),
        feature(mapping(box(1, 1, 2, 2)), layer="LED", name="torch", clearance=0.2),
        feature(mapping(box(5, 5, 7, 7)), name="logo"),
        feature(mapping(shapely.Point(3, 3)), layer="AXES"),
    )
    back = read(text, units="cm", outline="housing", keep_outs=("LED", "logo"))
    assert back.outline == rectangle(400, 500, centre=(200, -250))
    assert [(keep_out.name, keep_out.clearance) for keep_out in back.keep_outs] == [("torch", 2.0), ("logo", 0.0)]


def test_units_are_those_of_the_file_or_told():
    with pytest.raises(ValueError, match=r"GeoJSON is in degrees unless told otherwise.*units=mm"):
        read(json.dumps(SQUARE), units=None)
    text = collection(feature(SQUARE, layer="outline"), units="mm")
    assert read(text, units=None) == read(text, units="mm")
    with pytest.raises(ValueError, match=r"in which 1 is 1 mm .*, or not be given, got cm"):
        read(text, units="cm")
    with pytest.raises(ValueError, match=r"units must be one of .*, got 'parsec' in the file"):
        read(collection(feature(SQUARE, layer="outline"), units="parsec"), units=None)


def test_a_geometry_that_was_moved_is_not_taken_for_its_core():
    content = json.loads(write_geojson(Plan(Back.rounded_rectangle(40, 50, corner=5))))
    assert read(json.dumps(content), units=None) == Back.rounded_rectangle(40, 50, corner=5)
    moved = content["features"][0]["geometry"]["coordinates"][0]
    content["features"][0]["geometry"]["coordinates"][0] = [[x + 0.01, y] for x, y in moved]
    with pytest.raises(ValueError, match=r"features\[0\] must be its core grown by its radius, got a rim 0.01 mm off"):
        read(json.dumps(content), units=None)


def test_a_core_is_scaled_as_everything_else():
    text = write_geojson(Plan(Back.disc(3).keep_out("hole", disc((1, 1), 0.5), clearance=0.25)))
    back = read(text.replace('"units": "mm"', '"units": "cm"'), units=None)
    assert back.outline == disc((0, 0), 30)
    assert back.keep_outs[0].shape == disc((10, 10), 5)
    assert back.keep_outs[0].clearance == 2.5


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "GeoJSON must be whole JSON"),
        ("[]", "GeoJSON must be a record, got a list"),
        ("[" * 100_000, "GeoJSON must"),
        ('{"type": "Polygon", "coordinates": [[[0, 0], [NaN, 1], [5, 5]]]}', "must hold finite numbers, got NaN"),
        ('{"type": "Polygon", "coordinates": [[[0, 0], [1e999, 1], [5, 5], [0, 0]]]}', "must be finite and within"),
        ('{"type": "Polygon", "coordinates": 7}', "GeoJSON must be well formed, got a damaged 'Polygon'"),
        ('{"type": "Polygon"}', "GeoJSON must be well formed"),
        ('{"type": "Polygon", "coordinates": []}', "must be a Polygon or MultiPolygon, got an empty one"),
        ('{"type": "Point", "coordinates": [1, 2]}', "geometry must be a Polygon or MultiPolygon, got a Point"),
        ('{"type": "Sphere"}', "GeoJSON must be well formed, got a damaged 'Sphere'"),
        ('{"type": "FeatureCollection", "features": 7}', "features must be a list of at most 10000"),
        (collection(7), r"features\[0\] must be a feature with properties, got a int"),
        (collection(feature(None, layer="outline")), "the file has the layers none"),
        (
            collection(feature(mapping(shapely.Point(1, 1)), layer="outline")),
            r"must be a Polygon or MultiPolygon, got a 'Point'",
        ),
        (collection(feature(SQUARE, layer="outline", clearance="much")), r"features\[0\].clearance must be a number"),
        (collection(feature(SQUARE, layer="outline", core=SQUARE)), r"features\[0\].radius must be a number"),
        (collection(feature(SQUARE, layer="outline", core="x", radius=1)), "GeoJSON must be well formed"),
    ],
)
def test_what_is_damaged_is_refused(text: str, told: str):
    with pytest.raises(ValueError, match=told):
        read(text)
