import sys
from pathlib import Path

import pytest

from multilens.back import Back
from multilens.cad.drawing import Wanted
from multilens.cad.export import export
from multilens.cad.read import LARGEST_FILE, read_back, read_with_notes


def test_a_file_is_named_where_it_is_refused(tmp_path: Path):
    path = tmp_path / "phone.wkt"
    path.write_text("POLYGON EMPTY")
    with pytest.raises(ValueError, match=r"phone.wkt: line 1 must be a Polygon"):
        read_back(path, units="mm")


def test_the_end_of_the_name_decides_in_either_case(back: Back, tmp_path: Path):
    export(back, tmp_path / "BACK.SVG")
    assert read_back(tmp_path / "BACK.SVG") == back
    with pytest.raises(ValueError, match=r"must end in one of .dxf, .svg, .geojson, .json, .wkt, got .step"):
        read_back(tmp_path / "phone.step")


def test_a_file_too_large_is_not_read(tmp_path: Path):
    path = tmp_path / "phone.wkt"
    with path.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    with pytest.raises(ValueError, match=f"at most {LARGEST_FILE} bytes"):
        read_back(path, units="mm")


def test_what_is_no_text_is_refused(tmp_path: Path):
    path = tmp_path / "phone.svg"
    path.write_bytes(b"\xff\xfe<svg/>")
    with pytest.raises(ValueError, match=r"phone.svg: .*utf-8"):
        read_back(path)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan"), 11.0])
def test_a_tolerance_is_above_nothing(tolerance: float):
    with pytest.raises(ValueError, match="tolerance must be > 0 and at most 10 mm"):
        read_back("phone.svg", tolerance=tolerance)


@pytest.mark.parametrize(("form", "library"), [("dxf", "ezdxf"), ("svg", "svgelements")])
def test_a_library_that_is_not_there_is_named(form: str, library: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delitem(sys.modules, f"multilens.cad.read_{form}", raising=False)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ModuleNotFoundError, match=rf"{form.upper()} needs {library}, which is not installed"):
        read_back(tmp_path / f"phone.{form}")


def test_what_was_made_of_a_file_is_told(back: Back, tmp_path: Path):
    path = tmp_path / "phone.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90mm" height="90mm" viewBox="0 0 90 90">'
        '<ellipse id="rim" cx="40" cy="40" rx="40" ry="30"/><circle id="led" cx="40" cy="40" r="3"/><g id="notes"><rect id="box" '
        'width="1" height="1"/></g></svg>'
    )
    assert str(read_with_notes(path, None, Wanted("rim", ("LED",)))).splitlines() == [
        "outline: 79.99 x 59.99 mm, from (0.005, 10.005) to (79.995, 69.995)",
        "keep-outs: led",
        "cut into edges, on the safe side by at most 0.01 mm: outline",
        "layers not used: notes",
    ]
