import csv
from dataclasses import replace
from pathlib import Path

import pytest

from multilens.back import Back
from multilens.cad.export import export
from multilens.design import Design
from multilens.problem import Problem


def test_every_number_of_a_lens_reads_back_bit_for_bit(design: Design, tmp_path: Path):
    export(design, tmp_path / "layout.csv")
    with (tmp_path / "layout.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [[float(row["x_mm"]), float(row["y_mm"])] for row in rows] == design.layout.position.tolist()
    assert [float(row["aperture_radius_mm"]) for row in rows] == design.layout.aperture_radius.tolist()
    assert [float(row["body_radius_mm"]) - 1.0 for row in rows] == pytest.approx(design.layout.aperture_radius.tolist())


def test_names_are_handed_over(design: Design, tmp_path: Path):
    names = ["main", "tele", None]
    lenses = [replace(lens, name=name) for lens, name in zip(design.problem.lenses, names, strict=True)]
    named = replace(design, problem=Problem(design.problem.back, lenses, [300.0, 900.0]))
    export(named, tmp_path / "layout.csv")
    with (tmp_path / "layout.csv").open() as file:
        assert [row["name"] for row in csv.DictReader(file)] == ["main", "tele", ""]


def test_a_back_alone_has_no_table(back: Back, tmp_path: Path):
    with pytest.raises(ValueError, match="a table must have lenses, got a back alone"):
        export(back, tmp_path / "back.csv")
