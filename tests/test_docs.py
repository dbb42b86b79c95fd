"""What the pages say is what happens: their commands, snippets, tables and links.

A page is run from top to bottom in a folder of its own. A `yaml` block is written to the file that the line before it names, the
`python` blocks of a page share their names, and a command exits with 0 unless a comment after it says otherwise.

To stay within a minute, a command that searches is run with the overrides in QUICK, unless the page sets them itself: so of its
output the form is compared, not the numbers. Its pictures are drawn coarsely, and in a sweep not at all. An
exploration makes two trials.

A command for a cluster, with hydra/launcher=submitit_slurm in its first line, is run by tests/cluster/test_slurm.py.
Shapes are not enforced here, where time counts: every other test does that.
"""

import re
import shlex
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from itertools import pairwise
from pathlib import Path
from types import UnionType
from typing import Any, get_args, get_origin, get_type_hints

import jaxtyping
import pytest

import multilens as ml
from multilens.app.command import run_command
from multilens.app.compose import config_folder
from multilens.app.schema import Config, LensConfig, ShapeConfig
from multilens.app.schema_cues import SensorConfig

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")] + sorted(ROOT.glob("docs/*.md"))

QUICK = {"search.starts": "4", "search.patience": "0", "search.proof": "1", "depth.count": "24"}

CLUSTER = "hydra/launcher=submitit_slurm"

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?")


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, and the line of the page on which the text begins."""

    language: str
    text: str
    line: int


def blocks(page: Path) -> list[Block]:
    text = page.read_text(encoding="utf-8")
    return [Block(m[1], m[2], text.count("\n", 0, m.start(2)) + 1) for m in BLOCK.finditer(text)]


def files(page: Path) -> dict[str, str]:
    """Give the files that a page shows: the text of each by its path."""
    return dict(re.findall(r"(?m)^`([^`\n]+)`:\n\n```yaml\n((?:.*\n)*?)```$", page.read_text(encoding="utf-8")))


def prose(page: Path) -> str:
    return BLOCK.sub("", page.read_text(encoding="utf-8"))


def having(*languages: str) -> list[Path]:
    return [page for page in PAGES if any(block.language in languages for block in blocks(page))]


def each(pages: list[Path]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("page", pages, ids=lambda page: str(page.relative_to(ROOT)))


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    return tmp_path


@dataclass(frozen=True)
class Command:
    """A command line of a page, the exit code that the page promises and the output that it shows, None where it shows none."""

    line: int
    words: tuple[str, ...]
    code: int
    output: str | None


def commands(block: Block) -> list[Command]:
    lines = [(block.line + i, line) for i, line in enumerate(block.text.splitlines())]
    if block.language not in ("sh", "console"):
        return []
    shown = block.language == "console"
    starts = [
        i
        for i, (_, line) in enumerate(lines)
        if line.startswith("$ multilens " if shown else "multilens ") and CLUSTER not in line
    ]
    found = []
    for start, end in pairwise([*starts, len(lines)]):
        number, line = lines[start]
        promised = re.search(r"# exit code (\d+)$", line)
        words = tuple(shlex.split(line.removeprefix("$ "), comments=True))[1:]
        output = "\n".join(text for _, text in lines[start + 1 : end]) if shown else None
        found.append(Command(number, words, int(promised[1]) if promised else 0, output))
    return found


def quickly(command: Command) -> list[str]:
    if not any(word.startswith("experiment=") for word in command.words) or "--cfg" in command.words or command.code:
        return list(command.words)
    given = {word.partition("=")[0] for word in command.words}
    words = [*command.words, *(f"{key}={value}" for key, value in QUICK.items() if key not in given)]
    if words[0] == "explore":
        words = [*(word for word in words if not word.startswith("trials=")), "trials=2"]
    return words


def form(output: str) -> str:
    """Give an output without its numbers, and without what a search may find otherwise: which constraint is the tightest."""
    lines = re.sub(r"(?m)^(tightest clearance).*$", r"\1", output).splitlines()
    return "\n".join(" ".join(NUMBER.sub("#", line).split()) for line in lines)


@each(having("python", "sh", "console"))
def test_a_page_does_what_it_says(
    page: Path, elsewhere: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("multilens.plot.figures.DOTS_PER_INCH", 20)
    for path, text in files(page).items():
        (elsewhere / path).parent.mkdir(parents=True, exist_ok=True)
        (elsewhere / path).write_text(text, encoding="utf-8")
    names: dict[str, Any] = {"__name__": page.stem}
    for block in blocks(page):
        if block.language == "python":
            exec(compile("\n" * (block.line - 1) + block.text, str(page), "exec"), names)
            assert "ml" in names
            capsys.readouterr()
        for command in commands(block):
            run(command, f"{page.name}, line {command.line}", monkeypatch, capsys)


def run(command: Command, told: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Run a command of a page and hold its exit code and its output against what the page shows."""
    words = quickly(command)
    with monkeypatch.context() as here:
        here.setattr("sys.argv", ["multilens", *words])
        if "-m" in words:
            here.setattr("multilens.runs._draw", lambda design, folder: None)
        assert run_command(words) == command.code, told
    printed = "".join(capsys.readouterr())
    if command.output is not None and command.code:
        assert printed.strip() == command.output.strip(), told
    elif command.output is not None:
        assert form(printed).strip() == form(command.output).strip(), told


@each(PAGES)
def test_every_make_target_of_a_page_exists(page: Path):
    targets = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    text = page.read_text(encoding="utf-8")
    assert set(re.findall(r"(?:^|`)make (\w+)(?:$|`)", text, re.MULTILINE)) <= targets


@each(PAGES)
def test_every_link_leads_somewhere(page: Path):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"https?://", target):
            continue
        path, _, heading = target.partition("#")
        there = (page.parent / path).resolve() if path else page
        assert there.exists(), target
        assert there.is_relative_to(ROOT), target
        if heading:
            titles = re.findall(r"(?m)^#+ (.+)$", prose(there))
            assert heading in {title.lower().replace(" ", "-") for title in titles}, target


@each(PAGES)
def test_lists_begin_with_a_star(page: Path):
    """A line of a paragraph that begins with a minus, as of a formula, would be shown as an item of a list."""
    assert re.findall(r"(?m)^ *[-+] .*$", prose(page)) == []


def test_the_index_lists_every_page_once():
    listed = re.findall(r"\]\((\w+\.md)\)", (ROOT / "docs/README.md").read_text(encoding="utf-8"))
    assert sorted(listed) == sorted({page.name for page in ROOT.glob("docs/*.md")} - {"README.md"})


def test_the_index_lists_every_study():
    listed = set(re.findall(r"\]\(\.\./experiments/(\w+)/\)", (ROOT / "docs/README.md").read_text(encoding="utf-8")))
    assert listed == {readme.parent.name for readme in ROOT.glob("experiments/*/README.md")}


def test_the_reference_has_every_public_name_and_formula():
    told = {
        page: set(re.findall(r"(?m)^::: multilens\.(.+)$", (ROOT / "docs" / page).read_text(encoding="utf-8")))
        for page in ("reference.md", "formulae.md")
    }
    assert {name for name in told["reference.md"] if "." not in name} == set(dir(ml))
    modules = (ROOT / "src/multilens/optics").glob("[a-z]*.py")
    assert told["formulae.md"] == {f"optics.{path.stem}" for path in modules}


def section(page: str, heading: str) -> str:
    """Give what stands below a heading of a page, up to the next one."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.split(r"(?m)^#+ ", text.split(f"# {heading}\n", 1)[1])[0]


def first_cells(table: str) -> list[str]:
    return re.findall(r"(?m)^\| `([^`]+)` \|", table)


def schema_keys(kind: Any, above: str = "") -> Iterator[str]:
    """Give every key of the schema but those of shapes and lenses, which have tables of their own."""
    hints = get_type_hints(kind)
    for name in (field.name for field in fields(kind)):
        key, below = above + name, hints[name]
        named = get_origin(below) is dict
        if named:
            yield key
            key, below = f"{key}.NAME", get_args(below)[1]
        if is_dataclass(below) and below is not ShapeConfig:
            yield from schema_keys(below, f"{key}.")
        else:
            assert is_told(below), f"{key} is of a type that no table tells"
            yield key


def is_told(kind: Any) -> bool:
    """Whether a type is a plain one, or a shape or a lens, or a list or choice of those."""
    if isinstance(kind, UnionType) or get_origin(kind) is list:
        return all(is_told(one) for one in get_args(kind))
    return kind in (ShapeConfig, LensConfig) or not is_dataclass(kind)


@pytest.mark.parametrize(
    ("heading", "keys"),
    [
        ("Keys", list(schema_keys(Config))),
        ("Keys of a shape", [field.name for field in fields(ShapeConfig)]),
        ("Keys of a lens", [field.name for field in fields(LensConfig)]),
        ("Keys of a sensor", [field.name for field in fields(SensorConfig)]),
    ],
)
def test_the_tables_of_keys_are_the_schema(heading: str, keys: list[str]):
    assert first_cells(section("configuration.md", heading)) == keys


def test_the_table_of_groups_is_what_there_is():
    rows = re.findall(r"(?m)^\| (?:`(\w+)`)? ?\| `(\w+)` \|", section("configuration.md", "Groups"))
    listed, group = set(), ""
    for named, option in rows:
        group = named or group
        listed.add(f"{group}/{option}")
    there = config_folder().glob("*/*.yaml")
    assert listed == {f"{path.parent.name}/{path.stem}" for path in there}


def test_the_floors_are_those_that_are_enforced():
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = [set(layer.split(" | ")) for layer in contracts[0]["layers"]]
    rows = re.findall(r"(?m)^\| \d+ \| (.+) \|$", section("architecture.md", "Floors"))
    assert [set(re.findall(r"`(\w+)`", row)) for row in rows] == layers


def test_the_house_has_every_module():
    (tree,) = (block.text for block in blocks(ROOT / "docs/architecture.md") if block.text.startswith("src/"))
    found, folders = set(), []
    for line in tree.split("\nconf/")[0].splitlines()[1:]:
        depth, name = (len(line) - len(line.lstrip())) // 2, line.split()[0]
        folders = [*folders[: depth - 1], name]
        found.add("".join(folders))
    source = ROOT / "src/multilens"
    modules = {path.relative_to(source).as_posix() for path in source.rglob("*.py")}
    packages = {f"{path.parent.relative_to(source).as_posix()}/" for path in source.glob("*/__init__.py")}
    assert found == {name for name in modules if not name.endswith("/__init__.py")} | packages
