"""From the files of the repository to the pages of the site: MkDocs calls these functions while it builds.

The index, docs/README.md, says which pages there are: a heading for each tab, a row of its table for each page. What lies
outside of docs/ (the studies, the benchmark, the list of changes) is read where it lies, with all that it links to. Links are
written as they hold between files, so that they work in a checkout, and become here those of the site.
"""

import re
from os.path import relpath
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

DOCS = Path(__file__).parent
ROOT = DOCS.parent

LINK = re.compile(r"(?<=\]\()(?!\w+:)([^)#\s]+)")
ROW = re.compile(r"^\| \[([^]]+)\]\(([^)]+)\)", re.MULTILINE)


def on_config(config: MkDocsConfig) -> None:
    """Make the navigation of the tables of the index."""
    index = DOCS / "README.md"
    _, *sections = re.split(r"^## ", index.read_text(encoding="utf-8"), flags=re.MULTILINE)
    tabs = {section.partition("\n")[0]: ROW.findall(section) for section in sections}
    pages = {name: [{title: address(leads_to(index, link))} for title, link in rows] for name, rows in tabs.items()}
    config.nav = [{"Home": address(index)}, *({name: rows} for name, rows in pages.items() if rows)]


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Add what lies outside of docs/ and is linked to, however far the links lead."""
    waiting = [Path(file.abs_src_path) for file in files if file.src_uri.endswith(".md") and file.abs_src_path]
    for page in waiting:
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            path = leads_to(page, link)
            if path.is_file() and files.get_file_from_path(address(path)) is None:
                files.append(File.generated(config, address(path), abs_src_path=str(path)))
                waiting += [path] if path.suffix == ".md" else []


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Turn the links between files into those of the site."""
    source = Path(page.file.abs_src_path or DOCS / page.file.src_uri)
    here = Path(page.file.src_uri).parent

    def on_the_site(link: re.Match[str]) -> str:
        path = leads_to(source, link[1])
        return Path(relpath(address(path), here)).as_posix() if path.exists() else link[1]

    return LINK.sub(on_the_site, markdown)


def leads_to(page: Path, link: str) -> Path:
    """Give the file that a link of a page leads to; of a folder that is its README.md."""
    path = (page.parent / link).resolve()
    return path / "README.md" if path.is_dir() else path


def address(path: Path) -> str:
    """Give the name of a file on the site: pages of docs/ stand at its top, all others as in the repository."""
    path = path.relative_to(DOCS if path.is_relative_to(DOCS) else ROOT)
    return (path.with_suffix(".md") if path.suffix == ".ipynb" else path).as_posix()
