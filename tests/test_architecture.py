"""What the linters of imports, types and style cannot see of how the package is built."""

import ast
import subprocess
import sys
import tomllib
from importlib.metadata import requires
from pathlib import Path

import pytest
import torch
from jaxtyping import TypeCheckError

import multilens
from multilens.geometry.pairs import pair_distance

ROOT = Path(__file__).parents[1]
SOURCE = Path(multilens.__file__).parent
MODULES = sorted(SOURCE.rglob("*.py"))
LONGEST = 350
"""Lines of a module; about 130 is usual."""

IMPORTED_AS = {"hydra-core": {"hydra", "omegaconf", "yaml"}, "pillow": {"PIL"}}
"""Names under which a distribution is imported where they are not its own; Hydra brings OmegaConf and PyYAML."""

EXTRA_OF = {"cad": "cad", "sweeps/study.py": "optuna"}
"""The extra that brings what modules of a folder, or one module, import besides: its refusal says which one."""

each_module = pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(SOURCE)))


def tree(module: Path) -> ast.Module:
    return ast.parse(module.read_text(encoding="utf-8"))


def imported(module: Path) -> set[str]:
    names = set()
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.split(".")[0])
    return names


def optional(module: Path) -> set[str]:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    place = module.relative_to(SOURCE)
    extra = EXTRA_OF.get(place.parts[0], EXTRA_OF.get(place.as_posix(), ""))
    return {line.split(">")[0] for line in extras.get(extra, [])}


def declared() -> set[str]:
    needed = [line for line in requires("multilens") or [] if "extra ==" not in line]
    distributions = [line.split(";")[0].split(">")[0].split("=")[0].split("<")[0].strip() for line in needed]
    return {name for distribution in distributions for name in IMPORTED_AS.get(distribution, {distribution})}


@each_module
def test_a_module_imports_nothing_that_an_installation_would_lack(module):
    assert imported(module) <= declared() | optional(module) | set(sys.stdlib_module_names) | {"multilens"}


@each_module
def test_a_module_keeps_to_one_topic_of_a_readable_length(module):
    assert len(module.read_text(encoding="utf-8").splitlines()) <= LONGEST


@each_module
def test_numbers_become_tensors_with_a_type_that_is_stated(module):
    # torch.tensor of Python's floats is in single precision unless told otherwise: seven digits, silently.
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "torch.tensor":
            stated = any(keyword.arg in ("dtype", None) for keyword in node.keywords)
            assert stated, f"line {node.lineno}: torch.tensor without dtype"


def test_every_public_name_is_there():
    assert all(getattr(multilens, name) is not None for name in dir(multilens))


@pytest.mark.parametrize("module", ["multilens", "multilens.back", "multilens.lens", "multilens.app"])
def test_what_is_needed_to_answer_for_help_does_not_load_torch(module):
    program = f"import sys, {module}; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_shapes_are_enforced_while_tests_run():
    with pytest.raises(TypeCheckError):
        pair_distance(torch.zeros(3, 3))
