"""The page of one design, in a real browser, held against the design's file by the thesis' own formulae."""

import json
import re
from base64 import b64decode
from dataclasses import replace
from itertools import combinations
from math import hypot

import pytest
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from multilens.cues import LimitedStereo, PairLimits
from multilens.design import INFEASIBLE
from multilens.disturbance import Disturbance
from multilens.field_of_view import Field
from multilens.fusion import InverseVariance
from multilens.metrics import Relative
from multilens.report.run_page import run_page
from multilens.robust import Robust
from multilens.score_problem import ScoreProblem
from multilens.search.evaluate import as_given

pytestmark = pytest.mark.xdist_group("chromium")

SHOWN = 6e-3
"""Relative; errors are shown to three digits."""


@pytest.fixture(scope="module")
def page(design, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(run_page(design, "name: phone", "searched", "back.outline: drawn"), encoding="utf-8")
    return path


def best_by_hand(design, depth):
    """Give the name, the error and the baseline of the best measurement, from the numbers of the design's file alone."""
    file = json.loads(design.to_json())
    lenses = list(zip(file["layout"], file["problem"]["lenses"], strict=True))
    found = []
    for (i, (one, lens)), (j, (other, _)) in combinations(enumerate(lenses), 2):
        baseline = hypot(*(a - b for a, b in zip(one["position"], other["position"], strict=True)))
        error = depth**2 / baseline * lens["disparity_noise"] / lens["focal_length"]
        found.append(
            (
                error,
                f"stereo {i + 1}-{j + 1}",
                f"{baseline:.4g} mm",
                {f"pair-{i + 1}-{j + 1}", f"lens-{i + 1}", f"lens-{j + 1}"},
            )
        )
    for i, (placed, lens) in enumerate(lenses):
        for t, focus in enumerate(placed["focus"]):
            error = (
                depth * abs(depth - focus) * lens["blur_noise"] / (2 * placed["aperture_radius"] * lens["focal_length"])
            )
            found.append(
                (error, f"defocus {i + 1}" + (f" tier {t + 1}" if lens["tiers"] > 1 else ""), "-", {f"lens-{i + 1}"})
            )
    return min(found)


def told(browser):
    names = ("depth", "best", "error", "baseline", "blur")
    return {name: browser.find_element(By.ID, f"told-{name}").text for name in names}


def data(browser):
    return json.loads(browser.find_element(By.ID, "stops").get_attribute("textContent"))["stops"]


def lit(browser):
    ids = [part.get_attribute("id") for part in browser.find_elements(By.CSS_SELECTOR, "svg .lit")]
    return {name.removeprefix("layout-") for name in ids if name.startswith("layout-")}


def slide(browser, index):
    script = "const [slider, index] = arguments; slider.value = index; slider.dispatchEvent(new Event('input'))"
    browser.execute_script(script, browser.find_element(By.ID, "depth-slider"), index)


def test_at_every_tenth_stop_the_page_tells_what_the_file_holds(opened, page, design):
    browser = opened(page)
    stops = data(browser)
    for index in range(0, len(stops), len(stops) // 10):
        slide(browser, index)
        depth = stops[index]["millimetres"]
        error, best, baseline, parts = best_by_hand(design, depth)
        shown = told(browser)
        assert float(shown["depth"].removesuffix(" m")) == pytest.approx(depth / 1000, rel=SHOWN / 10)
        assert (shown["best"], shown["baseline"]) == (best, baseline)
        assert float(shown["error"].removesuffix(" mm")) == pytest.approx(error, rel=SHOWN)
        assert lit(browser) == parts


def test_the_slider_answers_to_the_keyboard_and_says_what_it_shows(opened, page):
    browser = opened(page)
    slider, stops = browser.find_element(By.ID, "depth-slider"), data(browser)
    for key, index in (
        (Keys.END, len(stops) - 1),
        (Keys.ARROW_LEFT, len(stops) - 2),
        (Keys.HOME, 0),
        (Keys.ARROW_RIGHT, 1),
    ):
        slider.send_keys(key)
        assert told(browser)["depth"] == stops[index]["depth"]
        assert slider.get_attribute("aria-valuetext") == "{depth}: {best}, error {error}".format(**stops[index])


def test_the_first_tab_reaches_the_slider_and_shows_it(opened, page):
    browser = opened(page)
    browser.find_element(By.TAG_NAME, "body").send_keys(Keys.TAB)
    focused = browser.switch_to.active_element
    assert focused.get_attribute("id") == "depth-slider"
    assert focused.value_of_css_property("outline-style") == "solid"


def test_a_click_on_the_curves_goes_to_that_depth(opened, page):
    browser = opened(page)
    curves, stops = browser.find_element(By.ID, "errors"), data(browser)
    script = "return document.getElementById(arguments[0]).getBoundingClientRect().toJSON()"
    line, whole = (browser.execute_script(script, name) for name in ("errors-depth-line", "errors"))
    for index in (20, 90):
        slide(browser, 0)
        at = line["x"] + line["width"] / 2 + stops[index]["right"] * whole["width"] / 400
        script = "arguments[0].dispatchEvent(new MouseEvent('click', {clientX: arguments[1], clientY: 0}))"
        browser.execute_script(script, curves, at)
        shown = next(stop for stop in stops if stop["depth"] == told(browser)["depth"])
        # Whoever points can point to a pixel.
        assert shown["right"] == pytest.approx(stops[index]["right"], abs=1)


def test_the_mark_stands_on_the_curve_at_its_depth(opened, page):
    browser = opened(page)
    for index in (0, 60):
        slide(browser, index)
        line = browser.find_element(By.ID, "errors-depth-line").get_attribute("transform")
        dot = browser.find_element(By.ID, "errors-depth-dot").get_attribute("transform")
        right, down = re.findall(r"-?[\d.]+", dot)
        assert re.findall(r"-?[\d.]+", line)[0] == right
        assert float(right) == pytest.approx(data(browser)[index]["right"])
        assert float(down) == pytest.approx(data(browser)[index]["down"])


def test_rows_of_lenses_light_up(opened, page, design):
    browser = opened(page)
    slide(browser, len(data(browser)) // 2)
    lenses = {f"lens-{row.text.split()[0]}" for row in browser.find_elements(By.CSS_SELECTOR, "#lenses tr.lit")}
    assert lenses == {part for part in lit(browser) if part.startswith("lens")}


@pytest.mark.parametrize("width", [360, 800, 1280])
def test_the_page_fits_its_window(opened, page, width):
    wider = "const page = document.documentElement; return page.scrollWidth > page.clientWidth"
    assert not opened(page, width).execute_script(wider)


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_keeps_anyone_out(opened, page, width, axe_violations):
    assert axe_violations(opened(page, width)) == []


def test_without_scripts_all_is_there_but_the_slider(opened, page):
    browser = opened(page, scripts=False)
    assert not browser.find_element(By.ID, "depth").is_displayed()
    assert len(browser.find_elements(By.CSS_SELECTOR, "#lenses tbody tr")) == 3
    assert browser.find_element(By.ID, "layout").is_displayed()


def test_on_paper_there_is_no_slider_and_every_row(opened, page):
    browser = opened(page)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        assert not browser.find_element(By.ID, "depth").is_displayed()
        script = "return [...document.querySelectorAll('.scroll')].map(e => e.scrollHeight <= e.clientHeight + 1)"
        assert all(browser.execute_script(script))
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert b64decode(browser.execute_cdp_cmd("Page.printToPDF", {})["data"]).startswith(b"%PDF")


def questions(design):
    problem = design.problem
    yield replace(problem, cues=[LimitedStereo(PairLimits(max_disparity=0.3))])
    yield replace(problem, fusion=InverseVariance(), field=Field.rings(80, 2))
    yield replace(problem, depths=[1000.0], weights=None)
    yield Robust(problem, Disturbance(covered=1.0), level=1)


@pytest.mark.parametrize("which", range(4), ids=["limited", "fused", "one depth", "robust"])
def test_other_questions_have_a_page_that_slides(opened, design, tmp_path, which):
    question = list(questions(design))[which]
    path = tmp_path / "report.html"
    path.write_text(run_page(as_given(question, design.layout)), encoding="utf-8")
    browser = opened(path)
    for index in {0, len(data(browser)) - 1}:
        slide(browser, index)
        assert told(browser)["best"] == data(browser)[index]["best"]


def test_a_score_of_ones_own_has_a_page_without_depths(opened, design, tmp_path):
    question = ScoreProblem(design.problem.back, design.problem.lenses, lambda layout: layout.aperture_radius.sum(-1))
    path = tmp_path / "report.html"
    path.write_text(run_page(as_given(question, design.layout)), encoding="utf-8")
    browser = opened(path)
    assert browser.find_element(By.ID, "layout").is_displayed()
    assert not browser.find_elements(By.ID, "depth-slider")


def test_an_infeasible_design_is_refused(design):
    with pytest.raises(ValueError, match="must be feasible to be reported: too small"):
        run_page(replace(design, status=INFEASIBLE, reason="too small"))


def test_an_error_is_told_in_mm_and_in_the_unit_of_the_metric(design):
    relative = as_given(replace(design.problem, metric=Relative()), design.layout)
    (stops,) = re.findall(r'<script[^>]*id="stops"[^>]*>(.*?)</script>', run_page(relative), re.DOTALL)
    for stop in json.loads(stops)["stops"]:
        mm, percent = re.fullmatch(r"([\d.e-]+) mm, ([\d.e-]+) %", stop["error"]).groups()
        assert float(percent) == pytest.approx(100 * float(mm) / stop["millimetres"], rel=2 * SHOWN)
