"""A page from its template: one file that holds its style, its script and its pictures, and forbids itself every request."""

from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from multilens.storage import versions

STYLE, SCRIPT = "report.css", "report.js"


def page(template: str, told: Mapping[str, Any]) -> str:
    """Give a page as HTML; whatever is told is text, save for what the template calls safe: pictures that were drawn here.

    Args:
        template: its file in the folder of templates.
        told: what the template speaks of; a name that it lacks counts as None.
    """
    style, script = _asset(STYLE), _asset(SCRIPT)
    # Only this very script may run, and nothing may be fetched; a picture has its colours as inline styles.
    digest = b64encode(sha256(script.encode()).digest()).decode()
    policy = f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
    whole = {"style": style, "script": script, "policy": policy, "version": versions()["multilens"]}
    return _environment().get_template(template).render(whole | {"told": told})


@cache
def _environment() -> Environment:
    loader = PackageLoader("multilens.report")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)


def _asset(name: str) -> str:
    return (files("multilens.report") / "templates" / name).read_text(encoding="utf-8")
