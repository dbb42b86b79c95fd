"""The wheel, installed away from the checkout, does what the README says in an empty folder.

Without an environment of its own, what the wheel needs is taken from the one of these tests; `make wheel-test` names the Python of
an empty environment into which the wheel was installed with all that it asks for.
"""

import os
import re
import shlex
import subprocess
import sys
import tarfile
from pathlib import Path
from zipfile import ZipFile

import pytest

from multilens.app.command import COMMANDS

ROOT = Path(__file__).parents[1]

PYTHON = "WHEEL_PYTHON"
"""Variable of the environment that names the Python into whose environment the wheel was installed."""

QUICK = ["search.starts=4", "search.patience=0", "search.proof=1", "depth.count=24"]

pytestmark = pytest.mark.xdist_group("wheel")


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a folder with the wheel and the source distribution."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-d", str(folder)], cwd=ROOT, check=True, capture_output=True
    )
    return folder


@pytest.fixture(scope="module")
def installed(built: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, str]]:
    """Give a Python that has the wheel, and the environment to run it in."""
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    if named := os.environ.get(PYTHON):
        return named, clean
    site = tmp_path_factory.mktemp("site")
    (wheel,) = built.glob("*.whl")
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(site), str(wheel)]
    subprocess.run(install, check=True)
    return sys.executable, clean | {"PYTHONPATH": str(site)}


def run(installed: tuple[str, dict[str, str]], here: Path, *words: str) -> str:
    python, environment = installed
    command = [python, "-c", "from multilens.app import main; main()", *words]
    done = subprocess.run(command, cwd=here, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_wheel_holds_presets_types_and_licence(built: Path):
    (wheel,) = built.glob("*.whl")
    names = set(ZipFile(wheel).namelist())
    presets = {f"multilens/{path.relative_to(ROOT).as_posix()}" for path in (ROOT / "conf").rglob("*.yaml")}
    modules = {path.relative_to(ROOT / "src").as_posix() for path in (ROOT / "src").rglob("*.py")}
    assert (presets | modules | {"multilens/py.typed"}) - names == set()
    assert {name.split("/")[0].split("-")[0] for name in names} == {"multilens"}
    assert any(name.endswith("licenses/LICENSE") for name in names)


def test_a_wheel_from_the_source_distribution_is_the_same(built: Path, tmp_path: Path):
    (source,), (wheel,) = built.glob("*.tar.gz"), built.glob("*.whl")
    with tarfile.open(source) as archive:
        archive.extractall(tmp_path, filter="data")
    (unpacked,) = tmp_path.iterdir()
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=unpacked, check=True, capture_output=True)
    (again,) = tmp_path.glob("*.whl")
    assert sorted(ZipFile(again).namelist()) == sorted(ZipFile(wheel).namelist())


def test_what_runs_is_what_was_installed(installed: tuple[str, dict[str, str]], tmp_path: Path):
    python, environment = installed
    asked = (
        "import multilens; from multilens.app.presets import config_folder; print(multilens.__file__, config_folder())"
    )
    done = subprocess.run(
        [python, "-c", asked], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert str(ROOT / "src") not in done.stdout
    assert str(ROOT / "conf") not in done.stdout


def test_a_design_is_made_reported_and_exported_in_an_empty_folder(
    installed: tuple[str, dict[str, str]], tmp_path: Path
):
    run(installed, tmp_path, "design", "experiment=phone_back", "hydra.run.dir=runs/phone", *QUICK)
    run(installed, tmp_path, "report", "runs/phone")
    run(installed, tmp_path, "export", "runs/phone", "layout.dxf")
    assert (tmp_path / "runs/phone/report.html").stat().st_size > 10_000
    assert "ENTITIES" in (tmp_path / "layout.dxf").read_text()


def test_the_commands_of_the_readme_run_in_an_empty_folder(installed: tuple[str, dict[str, str]], tmp_path: Path):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"(?ms)^```(?:sh|console)\n(.*?)^```$", readme)
    lines = [line for block in blocks for line in re.findall(r"(?m)^(?:\$ )?multilens (.*)$", block)]
    assert lines
    for line in lines:
        words = shlex.split(line, comments=True)
        searched = any(word.startswith("experiment=") for word in words)
        run(installed, tmp_path, *words, *(QUICK if searched else []))


def test_every_command_tells_its_help(installed: tuple[str, dict[str, str]], tmp_path: Path):
    for name in COMMANDS:
        assert run(installed, tmp_path, name, "--help").startswith(f"multilens {name} ")
