"""The site as it is built: without a warning, complete, and alike to whoever has no network.

It is built once, in a folder of its own, and its pages are read.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

ROOT = Path(__file__).parents[1]

pytestmark = pytest.mark.xdist_group("site")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site, which runs the notebook, and give its folder; a warning of MkDocs or its plugins is an error."""
    folder = tmp_path_factory.mktemp("site")
    build = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
    )
    assert build.returncode == 0, build.stderr
    return folder


class Pieces(HTMLParser):
    """What a page loads, where it leads, and the text of its paragraphs."""

    def __init__(self, page: Path):
        super().__init__()
        self.loads: list[str] = []
        self.leads: list[str] = []
        self.paragraphs: list[str] = []
        self.inside = False
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "p":
            self.paragraphs.append("")
        self.inside = tag == "p" or (self.inside and tag not in ("div", "table", "ul", "ol", "pre"))
        if tag in ("script", "img", "iframe", "source") and given.get("src"):
            self.loads.append(given["src"] or "")
        if tag == "link" and given.get("rel") not in ("next", "prev", "canonical"):
            self.loads.append(given["href"] or "")
        if tag == "a" and given.get("href"):
            self.leads.append(given["href"] or "")

    def handle_endtag(self, tag: str) -> None:
        self.inside = self.inside and tag != "p"

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.paragraphs[-1] += data


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Pieces]:
    # Of the page that a server shows for a wrong address nobody knows where it stands.
    return {page: Pieces(page) for page in site.rglob("*.html") if page.name != "404.html"}


def targets(page: Path, links: list[str]) -> Iterator[Path]:
    """Give the files that the links of a page to the site itself lead to."""
    for link in links:
        parts = urlsplit(link)
        if not parts.scheme and parts.path:
            yield (page.parent / unquote(parts.path)).resolve()


def test_nothing_is_loaded_from_elsewhere(pages: dict[Path, Pieces]):
    elsewhere = {link for pieces in pages.values() for link in pieces.loads if urlsplit(link).netloc}
    assert elsewhere == set()


def test_what_a_page_loads_and_leads_to_is_there(site: Path, pages: dict[Path, Pieces]):
    for page, pieces in pages.items():
        for target in targets(page, pieces.loads + pieces.leads):
            assert target.exists(), f"{page.relative_to(site)}: {target}"
            assert target.is_relative_to(site), f"{page.relative_to(site)}: {target}"


def test_lists_and_tables_are_not_run_into_paragraphs(site: Path, pages: dict[Path, Pieces]):
    """Python-Markdown wants an empty line before a list, which other readers do not."""
    for page, pieces in pages.items():
        for text in pieces.paragraphs:
            assert not re.search(r"(?m)^(\* |- |\d+\. |\| |```|:::)", text), f"{page.relative_to(site)}: {text}"


def test_every_page_and_study_is_on_the_site(site: Path):
    sources = [path for path in ROOT.glob("docs/*.md") if path.name != "README.md"]
    assert all((site / path.name).with_suffix(".html").is_file() for path in sources)
    assert all((site / path.relative_to(ROOT)).is_dir() for path in ROOT.glob("experiments/*/") if path.name[0] != "_")


def test_no_page_tells_where_it_was_built(pages: dict[Path, Pieces]):
    assert not [page for page in pages if str(ROOT) in page.read_text(encoding="utf-8")]


def test_the_notebook_was_run(site: Path, pages: dict[Path, Pieces]):
    page = site / "notebook.html"
    cells = json.loads((ROOT / "docs/notebook.ipynb").read_text(encoding="utf-8"))["cells"]
    drawn = [cell for cell in cells if "".join(cell["source"]).endswith(".plot()")]
    assert len([link for link in pages[page].loads if link.startswith("notebook_files/")]) == len(drawn) > 0
    assert "Warning" not in page.read_text(encoding="utf-8")


def test_no_output_is_kept_in_the_notebook():
    cells = json.loads((ROOT / "docs/notebook.ipynb").read_text(encoding="utf-8"))["cells"]
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells)
