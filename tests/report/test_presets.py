"""The reports of two presets as they are asked for: four cameras on a phone, and how many cameras pay."""

from collections.abc import Iterator
from dataclasses import replace

import jaxtyping
import pytest
from selenium.webdriver.common.by import By

from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.design import Design
from multilens.layout import Layout
from multilens.report.run_page import run_page
from multilens.report.sweep_page import sweep_page
from multilens.search.evaluate import as_given
from multilens.search.solve import solve
from multilens.sweep_row import SweepRow
from multilens.sweeps.job import row_of

pytestmark = pytest.mark.xdist_group("chromium")

LARGEST = 3_000_000
"""Bytes."""

# Not the best, nor all feasible: what a page takes does not depend on that.
PLACES = {
    "iphone_15_pro_max": [(9, 10), (67, 150), (66, 11), (10, 149), (38, 150), (9, 70), (67, 70), (58, 30)],
    "iphone_15_pro_max_island": [(9, 9), (36, 36), (9, 36), (22, 22), (38, 20), (22, 38), (9, 22), (22, 8)],
}
FOCI = [4820, 3110, 2050, 1400, 930, 620, 410, 280]


@pytest.fixture(autouse=True)
def quickly(monkeypatch: pytest.MonkeyPatch):
    """Leave shapes unchecked, as every other test checks them: this is a page of 84 pictures."""
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


def test_the_report_of_four_cameras_on_a_phone_is_small_and_slides(opened, tmp_path):
    problem = build_problem(read_given(["experiment=phone_back"]).config)
    path = tmp_path / "report.html"
    path.write_text(run_page(solve(problem, starts=2, patience=0, proof=1)), encoding="utf-8")
    assert path.stat().st_size < LARGEST
    browser = opened(path)
    slider = browser.find_element(By.ID, "depth-slider")
    script = "arguments[0].value = arguments[0].max; arguments[0].dispatchEvent(new Event('input'))"
    browser.execute_script(script, slider)
    assert browser.find_element(By.ID, "told-depth").text == "5.000 m"


def counted() -> Iterator[tuple[tuple[tuple[str, str], ...], Design]]:
    """Give the settings of the 48 jobs of camera_count, and a layout for each without a search."""
    for depth in ("near", "far", "room"):
        for back, places in PLACES.items():
            words = [f"depth={depth}", f"back={back}", "lenses=iphone_main", "lenses.count=8"]
            whole = build_problem(read_given(words).config)
            for count in range(1, 9):
                problem = replace(whole, lenses=whole.lenses[:count])
                layout = Layout(places[:count], [1.5] * count, FOCI[:count])
                settings = (("depth", depth), ("back", back), ("lenses.count", str(count)))
                yield settings, as_given(problem, layout)


def test_the_report_of_a_sweep_of_48_jobs_is_small_and_linked(opened, tmp_path):
    jobs = dict(enumerate(counted()))
    rows: list[SweepRow] = [row_of(design, job, settings, 1.0) for job, (settings, design) in jobs.items()]
    path = tmp_path / "report.html"
    path.write_text(sweep_page(rows, {job: design for job, (_, design) in jobs.items()}), encoding="utf-8")
    assert path.stat().st_size < LARGEST
    browser = opened(path)
    assert len(browser.find_elements(By.CSS_SELECTOR, ".card")) == 48
    (chart,) = [figure for figure in browser.find_elements(By.CSS_SELECTOR, ".charts figure") if figure.is_displayed()]
    chart.find_element(By.CSS_SELECTOR, 'a[href="#job-3"]').click()
    panel = browser.find_element(By.ID, "chosen")
    assert "depth near, back iphone_15_pro_max, count 4" in panel.text
    assert len(panel.find_elements(By.CSS_SELECTOR, "tbody tr")) == 4
