import pytest

from multilens.back import Back
from multilens.depths import linear_depths
from multilens.lens import Lens
from multilens.plot.units import DepthUnit, depth_unit, significant
from multilens.problem import Problem

MILLIMETRE, METRE = DepthUnit("mm", 1.0), DepthUnit("m", 1000.0)


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (4.8, "4.80"),
        (0.2049, "0.205"),
        (1234.0, "1230"),
        (9.996, "10.0"),
        (-0.5, "-0.500"),
        (0.0, "0"),
        (2e-9, "2e-09"),
    ],
)
def test_three_digits_that_count(number, words):
    assert significant(number) == words


@pytest.mark.parametrize(
    ("unit", "near", "far", "words"),
    [
        (METRE, 200, 5000, "0.20 to 5.00 m"),
        (METRE, 20, 5000, "0.020 to 5.000 m"),
        (MILLIMETRE, 20, 50, "20 to 50 mm"),
        (MILLIMETRE, 0.5, 2, "0.50 to 2.00 mm"),
    ],
)
def test_a_range_has_the_same_decimals_at_both_ends(unit, near, far, words):
    assert unit.range(near, far) == words


@pytest.mark.parametrize(("far", "name"), [(999, "mm"), (1000, "m")])
def test_metres_from_a_metre_on(far, name):
    problem = Problem(Back.rectangle(9, 9), [Lens(5, (1, 2))], linear_depths(100, far, 4))
    assert depth_unit(problem).name == name
