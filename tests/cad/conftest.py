"""A back with everything that a shape can be, and a design on it."""

import pytest
from shapely import LineString, Polygon

from multilens.back import Back
from multilens.certificate import certify
from multilens.cues import LensDefocus, PairStereo
from multilens.design import Design
from multilens.geometry.shape import Shape, disc, polygon, rectangle
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem


@pytest.fixture(scope="session")
def back() -> Back:
    notched = polygon([(50, 50), (60, 50), (60, 55), (55, 55), (55, 70), (50, 70)], [[(51, 51), (53, 51), (53, 54)]])
    hexagon = Polygon([(30, 120), (36, 118), (41, 122), (40, 130), (33, 132), (29, 126)])
    return (
        Back.rounded_rectangle(76.73, 159.86, corner=13)
        .keep_out("flash", disc((32.16, 10.22), 3.45), clearance=0.5)
        .keep_out("lidar", rectangle(4.06, 7.06, centre=(32.16, 38.22)))
        .keep_out("notched", notched, clearance=1.25)
        .keep_out("slot", Shape(LineString([(10, 90), (14.5, 99.3)]), 1.5))
        .keep_out("round hexagon", Shape(hexagon, 0.75), clearance=0.1)
    )


@pytest.fixture(scope="session")
def design(back: Back) -> Design:
    lens = Lens(5.0, (0.5, 2.0), (200, 5000), clearance=1.0)
    problem = Problem(back, [lens] * 3, [300.0, 900.0, 2000.0], cues=[PairStereo(), LensDefocus()])
    layout = Layout([[12.1, 16.2], [61.1, 146.2], [60.0, 20.0]], [1.25, 2.0, 0.75], [300.3, 900.9, 1234.5])
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    assert certificate.feasible
    return Design(problem, layout, "complete", "", certificate)
