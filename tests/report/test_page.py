import re
from base64 import b64encode
from hashlib import sha256
from html.parser import HTMLParser

import pytest

from multilens.report.run_page import run_page


@pytest.fixture(scope="module")
def text(design):
    return run_page(design, "config: </pre><script>1</script>", "log", "back.outline: drawn")


class Elements(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


@pytest.fixture(scope="module")
def elements(text):
    return Elements(text).found


def test_what_a_design_holds_stays_text(elements):
    tags = [tag for tag, _ in elements]
    assert not {"img", "iframe", "object", "link", "form"} & set(tags)
    assert sum(tag == "script" for tag in tags) == 2
    assert not any(name.startswith("on") for _, attributes in elements for name in attributes)


def test_templates_are_not_run_twice(text):
    assert "49" not in re.findall(r"onerror=alert\(1\).{0,80}", text)[0]
    assert "{{ 7*7 }}" in text


def test_only_the_page_s_own_script_may_run(text):
    script = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)[-1]
    digest = b64encode(sha256(script.encode()).digest()).decode()
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]+)"', text)
    assert policy.replace("&#39;", "'").startswith(f"default-src 'none'; script-src 'sha256-{digest}'; ")


def test_nothing_is_fetched(elements):
    targets = [
        value
        for _, attributes in elements
        for name, value in attributes.items()
        if name in ("src", "href", "xlink:href")
    ]
    assert all(target.startswith("#") for target in targets)


def test_every_id_is_there_once(elements):
    ids = [attributes["id"] for _, attributes in elements if "id" in attributes]
    assert len(ids) == len(set(ids))


def test_every_reference_leads_to_an_id(text, elements):
    ids = {attributes["id"] for _, attributes in elements if "id" in attributes}
    assert set(re.findall(r"url\(#([^)]+)\)", text)) | set(re.findall(r'xlink:href="#([^"]+)"', text)) <= ids


def test_the_same_design_gives_the_same_bytes(design, text):
    assert run_page(design, "config: </pre><script>1</script>", "log", "back.outline: drawn") == text
