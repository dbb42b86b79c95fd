from dataclasses import replace

from multilens.layout import Layout
from multilens.layout_table import f_numbers, foci, layout_lines
from multilens.lens import Lens

LENSES = [Lens(5.0, (0.5, 2.0)), Lens(10.0, (0.5, 2.0), tiers=2)]
LAYOUT = Layout([[20.1, 30.2], [5.25, 170.2]], [1.25, 2.0], [[300.26, 300.26], [900.9, 2000.1]])


def test_f_numbers_are_focal_lengths_over_diameters():
    assert f_numbers(LAYOUT, LENSES) == (2.0, 2.5)


def test_a_lens_has_as_many_foci_as_tiers():
    assert foci(LAYOUT, LENSES) == ((300.26,), (900.9, 2000.1))


def test_every_lens_has_a_line_of_columns():
    assert layout_lines(LAYOUT, LENSES) == [
        "lens  x (mm)   y (mm)  aperture radius (mm)  f-number     focus (mm)",
        "   1  20.100   30.200                 1.250      2.00          300.3",
        "   2   5.250  170.200                 2.000      2.50  900.9, 2000.1",
    ]


def test_names_stand_beside_the_numbers_where_they_tell_one_lens_from_another():
    named = [replace(lens, name=name) for lens, name in zip(LENSES, ("main", "ultra-wide"), strict=True)]
    assert [line[:24] for line in layout_lines(LAYOUT, named)] == [
        "lens  name        x (mm)",
        "   1  main        20.100",
        "   2  ultra-wide   5.250",
    ]
    alike = [replace(lens, name="main") for lens in LENSES]
    assert layout_lines(LAYOUT, alike) == layout_lines(LAYOUT, LENSES)
