import sys
from dataclasses import replace
from pathlib import Path

import pytest

import multilens as ml
from multilens.back import Back
from multilens.cad.export import export, export_all
from multilens.design import INFEASIBLE, Design


def test_a_file_that_is_there_is_kept_unless_it_may_be_replaced(back: Back, tmp_path: Path):
    path = tmp_path / "back.svg"
    path.write_text("a picture")
    with pytest.raises(
        ValueError, match=r"back.svg must be a new file, it is there already: overwrite=true replaces it"
    ):
        export(back, path)
    assert path.read_text() == "a picture"
    export(back, path, overwrite=True)
    assert path.read_text().startswith("<svg")


def test_nothing_is_written_unless_everything_can_be(back: Back, tmp_path: Path):
    with pytest.raises(ValueError, match="a table must have lenses"):
        export_all(back, [tmp_path / "back.svg", tmp_path / "back.csv"], overwrite=False)
    assert list(tmp_path.iterdir()) == []


def test_other_ends_are_refused(back: Back, tmp_path: Path):
    with pytest.raises(ValueError, match=r"must end in one of .dxf, .svg, .geojson, .csv, got .step"):
        export(back, tmp_path / "back.step")


def test_a_folder_that_is_not_there_is_not_made(back: Back, tmp_path: Path):
    with pytest.raises(ValueError, match="must be a file in a folder that is there"):
        export(back, tmp_path / "away" / "back.svg")


def test_a_design_without_a_layout_is_refused(design: Design, tmp_path: Path):
    with pytest.raises(ValueError, match="design must have a layout to be exported: no room"):
        export(replace(design, status=INFEASIBLE, reason="no room"), tmp_path / "layout.svg")


def test_a_library_that_is_not_there_is_named(back: Back, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "multilens.cad.write_dxf", None)
    monkeypatch.delitem(sys.modules, "multilens.cad.write_dxf")
    monkeypatch.delitem(sys.modules, "multilens.cad.read_dxf", raising=False)
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(
        ModuleNotFoundError, match=r"DXF needs ezdxf, which is not installed: pip install 'multilens\[cad\]'"
    ):
        export(back, tmp_path / "back.dxf")
    export(back, tmp_path / "back.svg")


def test_both_ways_are_public():
    assert ml.export is export
    assert ml.read_back.__name__ == "read_back"
