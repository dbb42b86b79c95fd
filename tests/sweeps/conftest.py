"""A design that costs no search."""

from dataclasses import replace

import pytest

from multilens.back import Back
from multilens.certificate import certify
from multilens.design import Design
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem


@pytest.fixture(scope="session")
def design() -> Design:
    """Give two lenses, 30 mm apart along x and 40 mm along y, on a back of 40 by 60 mm."""
    lens = Lens(5.0, (0.5, 2.0), (200, 5000), clearance=1.0)
    problem = Problem(Back.rectangle(40, 60), [lens, replace(lens, tiers=2)], [300.0, 900.0, 2000.0])
    layout = Layout([[5.1, 6.2], [35.1, 46.2]], [1.25, 2.0], [[300.3, 300.3], [900.9, 2000.1]])
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    return Design(problem, layout, "complete", "", certificate)
