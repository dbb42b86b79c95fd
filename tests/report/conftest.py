"""A real browser without a window, and pages opened in it as a double click would."""

import json
import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from axe_core_python.selenium import Axe
from selenium.webdriver import Chrome, ChromeOptions, ChromeService

from multilens.back import Back
from multilens.bounds.bound import Bound
from multilens.depths import log_depths
from multilens.design import COMPLETE, Design
from multilens.geometry.shape import disc
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.search.evaluate import as_given
from multilens.storage import Origin
from multilens.tolerance import Tolerance

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")

QUIET = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars",
)  # fmt: skip


@pytest.fixture(scope="session")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    if CHROMIUM is None or DRIVER is None:
        missing = "chromium and chromedriver are not installed"
        pytest.fail(missing) if os.environ.get("CI") else pytest.skip(missing)
    options = ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in (*QUIET, f"--user-data-dir={tmp_path_factory.mktemp('chromium')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = Chrome(options, ChromeService(DRIVER))
    # Away from the page that the browser begins with, which asks for parts of itself.
    driver.get("about:blank")
    try:
        yield driver
    finally:
        driver.quit()


@pytest.fixture
def opened(chromium: Chrome) -> Iterator[Callable[..., Chrome]]:
    """Open a page of a size in the browser; at the end nothing was said on its console and nothing was asked of a network."""

    def at(path: Path, width: int = 1280, height: int = 1000, scripts: bool = True) -> Chrome:
        chromium.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": not scripts})
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        chromium.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        chromium.get(path.as_uri())
        return chromium

    for log in ("browser", "performance"):
        chromium.get_log(log)
    yield at
    assert chromium.get_log("browser") == []
    assert [url for url in requests(chromium) if not url.startswith(("file:", "chrome:"))] == []


def requests(chromium: Chrome) -> list[str]:
    events = [json.loads(entry["message"])["message"] for entry in chromium.get_log("performance")]
    return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]


HOSTILE = "</script><img src=x onerror=alert(1)>--><!-- &lt; \"' {{ 7*7 }}"
NOISE = 0.2 * 1.22e-3


@pytest.fixture(scope="session")
def hostile() -> str:
    """What would run if a page took it for anything but text."""
    return HOSTILE


@pytest.fixture(scope="session")
def design() -> Design:
    """Three lenses on a back of 60 by 90 mm, one of them with two foci, a keep-out with a hostile name."""
    lens = Lens(6.86, (0.5, 1.93), (200, 5000), 4.0, NOISE, NOISE)
    back = Back.rounded_rectangle(60, 90, 10).keep_out(HOSTILE, disc((30, 20), 4), 0.5)
    problem = Problem(back, [lens, replace(lens, tiers=2), lens], log_depths(200, 5000, 128))
    layout = Layout([[8, 8], [50, 80], [10, 60]], [1.93, 1.5, 1.0], [[3000, 3000], [900, 4500], [400, 400]])
    found = as_given(problem, layout)
    origin = Origin(7, 32, 3, "distance_penalty", None, {"torch": HOSTILE}, "0123abc+")
    return replace(found, status=COMPLETE, origin=origin, bound=Bound(0.9 * found.score), tolerance=Tolerance(mm=3.0))


@pytest.fixture
def axe_violations() -> Callable[[Chrome], list[str]]:
    """Give what axe-core finds wrong with a page, for those who cannot see it or use no mouse."""

    def found(page: Chrome) -> list[str]:
        violations = Axe().run(page)["violations"]
        return [f"{one['id']}: {[node['html'] for node in one['nodes']][:3]}" for one in violations]

    return found
