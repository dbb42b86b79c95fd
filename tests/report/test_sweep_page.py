"""The page of a sweep, in a real browser, held against its rows and its jobs' designs."""

from dataclasses import replace

import pytest
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from multilens.layout import Layout
from multilens.metrics import MeanSquare, Relative
from multilens.report.sweep_page import MOST_JOBS, MOST_LAYOUTS, sweep_page, worth_drawing, worth_telling
from multilens.search.evaluate import as_given
from multilens.sweep_row import SweepRow
from multilens.sweeps.job import row_of

pytestmark = pytest.mark.xdist_group("chromium")


@pytest.fixture(scope="module")
def designs(design):
    """Two and three lenses, narrow and wide, without a search."""
    problem, found = design.problem, {}
    for job, (count, radius) in enumerate([(2, 0.5), (3, 0.5), (2, 1.9), (3, 1.9)]):
        lenses = [problem.lenses[0]] * count
        places = [[8, 8], [50, 80], [10, 60]][:count]
        layout = Layout(places, [radius] * count, [[3000], [900], [400]][:count])
        found[job] = as_given(replace(problem, lenses=lenses), layout)
    return found


@pytest.fixture(scope="module")
def rows(designs, hostile):
    def settings(job, design):
        return (("lenses.count", str(design.layout.count)), ("wide", f"{hostile}{job // 2}"), ("search.seed", "0"))

    rows = [row_of(design, job, settings(job, design), 1.5) for job, design in designs.items()]
    return [*rows, SweepRow(4, (("lenses.count", "9"), ("wide", hostile), ("search.seed", "0")), "infeasible", hostile)]


@pytest.fixture(scope="module")
def page(rows, designs, tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "report.html"
    path.write_text(sweep_page(rows, designs), encoding="utf-8")
    return path


def chosen(browser):
    """Give the job that the page shows as chosen, its figure and its lenses."""
    panel = browser.find_element(By.ID, "chosen")
    job = browser.find_element(By.ID, "chosen-title").text.removeprefix("Job ")
    lenses = panel.find_elements(By.CSS_SELECTOR, "tbody tr")
    return job, panel.find_element(By.TAG_NAME, "b").text, [row.text.split()[:3] for row in lenses]


def expected(rows, designs, job):
    places = designs[job].layout.position.tolist()
    lenses = [[str(k + 1), f"{x:.3f}", f"{y:.3f}"] for k, (x, y) in enumerate(places)]
    return str(job), f"RMSE {rows[job].figure:#.4g} mm", lenses


def shown_chart(browser):
    (chart,) = [figure for figure in browser.find_elements(By.CSS_SELECTOR, ".charts figure") if figure.is_displayed()]
    return chart


def click(browser, element):
    """Click as a reader does: with a pointer, where the element is."""
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
    element.click()


def test_figures_in_other_units_do_not_compete_with_those_that_are_shown_first(designs):
    found = {}
    for job, metric in enumerate((MeanSquare(), MeanSquare(), Relative(), Relative())):
        found[job] = as_given(replace(designs[job].problem, metric=metric), designs[job].layout)
    words = ("mean_square", "mean_square", "relative", "relative")
    settings = [(("metric", word), ("lenses.count", str(2 + job % 2))) for job, word in enumerate(words)]
    rows = [row_of(design, job, settings[job], 1.5) for job, design in found.items()]
    assert max(row.figure for row in rows[2:]) < min(row.figure for row in rows[:2])
    best = min((0, 1), key=lambda job: rows[job].figure)
    assert f'data-first="{best}"' in sweep_page(rows, found)


def test_the_best_job_is_chosen_first(opened, page, rows, designs):
    best = min(designs, key=lambda job: rows[job].figure)
    assert chosen(opened(page)) == expected(rows, designs, best)


@pytest.mark.parametrize("job", [0, 1, 3])
def test_a_point_leads_to_its_job(opened, page, rows, designs, job):
    browser = opened(page)
    click(browser, shown_chart(browser).find_element(By.CSS_SELECTOR, f'a[href="#job-{job}"]'))
    assert chosen(browser) == expected(rows, designs, job)


def test_a_row_and_a_layout_lead_to_their_job(opened, page, rows, designs):
    browser = opened(page)
    click(browser, browser.find_element(By.CSS_SELECTOR, '#jobs tr[data-job="1"] td'))
    assert chosen(browser) == expected(rows, designs, 1)
    click(browser, browser.find_element(By.CSS_SELECTOR, "#job-2 svg"))
    assert chosen(browser) == expected(rows, designs, 2)


def test_a_point_is_reached_and_chosen_by_the_keyboard(opened, page, rows, designs):
    browser = opened(page)
    point = shown_chart(browser).find_element(By.CSS_SELECTOR, 'a[href="#job-1"]')
    browser.execute_script("arguments[0].focus()", point)
    browser.switch_to.active_element.send_keys(Keys.ENTER)
    assert chosen(browser) == expected(rows, designs, 1)


def test_the_chosen_job_is_marked_everywhere(opened, page):
    browser = opened(page)
    click(browser, browser.find_element(By.CSS_SELECTOR, '#jobs a[href="#job-2"]'))
    marked = browser.find_elements(By.CSS_SELECTOR, ".chosen")
    assert {element.get_attribute("data-job") or element.get_attribute("href") for element in marked} == {
        "2",
        *(element.get_attribute("href") for element in browser.find_elements(By.CSS_SELECTOR, 'a[href="#job-2"]')),
    }


def test_axes_can_be_chosen(opened, page):
    browser = opened(page)
    lists = {name: Select(browser.find_element(By.ID, f"choose-{name}")) for name in ("up", "right")}
    lists["right"].select_by_visible_text("area of all apertures (mm²)")
    assert "area of all apertures" in shown_chart(browser).find_element(By.TAG_NAME, "figcaption").text
    for up in lists["up"].options:
        lists["up"].select_by_visible_text(up.text)
        for right in lists["right"].options:
            lists["right"].select_by_visible_text(right.text)
            assert shown_chart(browser).get_attribute("data-right") == right.text


@pytest.mark.parametrize("name", ["figure", "wide", "longest baseline mm"])
def test_a_head_sorts_the_table_both_ways(opened, page, name):
    browser = opened(page)
    heads = browser.find_elements(By.CSS_SELECTOR, "#jobs thead th")
    column = next(k for k, head in enumerate(heads) if head.text == name)
    for ends, backwards in (("ascending", False), ("descending", True)):
        click(browser, heads[column].find_element(By.TAG_NAME, "button"))
        assert heads[column].get_attribute("aria-sort") == ends
        shown = [cell.text for cell in browser.find_elements(By.CSS_SELECTOR, f"#jobs tr > :nth-child({column + 1})")][
            1:
        ]
        assert shown == sorted(shown, key=lambda words: words if name == "wide" else float(words), reverse=backwards)


def test_a_link_from_elsewhere_opens_its_job(opened, page, rows, designs):
    browser = opened(page)
    browser.get(f"{page.as_uri()}#job-1")
    browser.refresh()
    assert chosen(browser) == expected(rows, designs, 1)


def test_a_job_without_a_design_is_told_with_its_reason(opened, page, hostile):
    browser = opened(page)
    cells = [cell.text for cell in browser.find_elements(By.CSS_SELECTOR, "#failed tbody tr > *")]
    assert (cells[0], cells[2], cells[3]) == ("4", "infeasible", " ".join(hostile.split()))


@pytest.mark.parametrize("width", [360, 1280])
def test_the_page_fits_its_window_and_keeps_nobody_out(opened, page, width, axe_violations):
    browser = opened(page, width)
    wider = "const page = document.documentElement; return page.scrollWidth > page.clientWidth"
    assert not browser.execute_script(wider)
    assert axe_violations(browser) == []


def test_without_scripts_links_lead_to_the_layouts_with_their_numbers(opened, page):
    browser = opened(page, scripts=False)
    assert not browser.find_element(By.ID, "chosen").is_displayed()
    assert all(figure.is_displayed() for figure in browser.find_elements(By.CSS_SELECTOR, ".charts figure"))
    assert browser.find_element(By.CSS_SELECTOR, "#job-1 summary").is_displayed()


def test_the_same_sweep_gives_the_same_bytes(page, rows, designs):
    assert sweep_page(rows, designs) == page.read_text(encoding="utf-8")


def test_of_many_jobs_the_least_figures_are_told():
    rows = [SweepRow(job, (), "complete", lens_count=4, figure=1000.0 - job) for job in range(MOST_JOBS + 50)]
    assert [row.job for row in worth_telling(rows)][:2] == [MOST_JOBS + 49, MOST_JOBS + 48]
    assert (len(worth_telling(rows)), len(worth_drawing(rows))) == (MOST_JOBS, MOST_LAYOUTS)


def test_of_layouts_with_many_lenses_fewer_are_drawn():
    rows = [SweepRow(job, (), "complete", lens_count=100, figure=1.0) for job in range(20)]
    assert len(worth_drawing(rows)) == 2


def test_a_sweep_in_which_nothing_was_found_has_a_page(opened, tmp_path):
    (tmp_path / "report.html").write_text(sweep_page([SweepRow(0, (("a", "1"),), "refused", "why")], {}))
    assert "why" in opened(tmp_path / "report.html").find_element(By.ID, "failed").text


def test_no_jobs_have_no_page():
    with pytest.raises(ValueError, match="at least one job"):
        sweep_page([], {})
