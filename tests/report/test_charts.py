import re

import pytest

from multilens.report.charts import BEATEN, UNBEATEN, charts, where
from multilens.sweep_row import SweepRow


def row(job, count, back, near, figure, area=100.0, unit="mm"):
    settings = (("lenses.count", str(count)), ("back", back), ("depth.near", str(near)))
    if figure is None:
        return SweepRow(job, settings, "infeasible", "too small")
    numbers = {"figure": figure, "unit": unit, "score": figure**2, "rmse": figure, "measured": 1.0, "back_area": area}
    return SweepRow(job, settings, "complete", lens_count=count, metric="RMSE", **numbers)


ROWS = [
    row(0, 1, "whole", 200, 8.0, 900),
    row(1, 2, "whole", 200, 2.0, 900),
    row(2, 1, "island", 200, 9.0, 300),
    row(3, 2, "island", 200, 4.0, 300),
    row(4, 3, "island", 200, None),
    row(5, 1, "whole", 400, 11.0, 900),
    row(6, 2, "whole", 400, 3.0, 900),
]


def words(row):
    return f"job {row.job}"


@pytest.fixture(scope="module")
def found():
    return charts(ROWS, words)


def links(svg):
    return re.findall(r'href="#job-(\d+)"', svg)


def texts(svg):
    return re.findall(r">([^<>]+)</text>", svg)


def test_only_what_was_asked_alike_is_compared(found):
    jobs = {chart.question: set(links(chart.svg)) for chart in found if chart.right == "lenses.count"}
    assert jobs == {"near 200": {"0", "1", "2", "3"}, "near 400": {"5", "6"}}


def test_along_a_swept_number_jobs_alike_in_all_else_are_joined(found):
    chart = next(chart for chart in found if (chart.question, chart.right) == ("near 200", "lenses.count"))
    assert {"back whole", "back island"} <= set(texts(chart.svg))


def test_along_anything_else_those_that_no_other_beats_are(found):
    chart = next(chart for chart in found if chart.right == "area of the back (mm²)")
    assert {UNBEATEN, BEATEN} <= set(texts(chart.svg))
    # Of the larger back 2 mm, of the smaller 4 mm; the jobs of one lens are worse for the same area.
    unbeaten = re.search(r'id="chart-\d+-PathCollection_1">(.*?)id="chart-\d+-PathCollection_2">', chart.svg)
    assert sorted(links(unbeaten[1])) == ["1", "3"]


def test_axes_along_which_nothing_differs_have_no_chart(found):
    assert {chart.right for chart in found if chart.question == "near 400"} == {"lenses.count"}
    assert {chart.up for chart in found} == {"RMSE (mm)"}


def test_every_point_says_which_job_it_is(found):
    assert all(f'aria-label="job {job}"' in chart.svg for chart in found for job in links(chart.svg))
    assert where(ROWS[3]) == "#job-3"


def test_a_sweep_in_which_nothing_differs_has_no_charts():
    assert charts([ROWS[0]], words) == ()
    assert charts([row(0, 1, "whole", 200, None)], words) == ()
