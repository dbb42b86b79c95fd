"""What the tests of several studies need."""

import sys
from collections.abc import Iterator
from importlib.util import module_from_spec, spec_from_file_location
from types import ModuleType

import pytest


@pytest.fixture(scope="module")
def study(request: pytest.FixtureRequest) -> Iterator[dict[str, ModuleType]]:
    """The modules beside a test that its MODULES names, which find each other as those of a script do."""
    modules: dict[str, ModuleType] = {}
    with pytest.MonkeyPatch.context() as patch:
        for name in request.module.MODULES:
            spec = spec_from_file_location(f"{request.path.parent.name}_{name}", request.path.with_name(f"{name}.py"))
            assert spec is not None
            assert spec.loader is not None
            modules[name] = module_from_spec(spec)
            # By its own name for what makes dataclasses, by the plain one for its neighbours.
            patch.setitem(sys.modules, spec.name, modules[name])
            patch.setitem(sys.modules, name, modules[name])
            spec.loader.exec_module(modules[name])
        yield modules
