"""Hydra, set up to compose a configuration as its own command line would."""

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hydra import __version__ as hydra_version
from hydra import version
from hydra._internal.config_loader_impl import ConfigLoaderImpl
from hydra._internal.hydra import Hydra
from hydra._internal.utils import create_config_search_path
from hydra.core.config_loader import ConfigLoader
from hydra.core.config_search_path import SearchPathQuery
from hydra.core.global_hydra import GlobalHydra

from multilens.app.presets import config_folder
from multilens.app.schema import register

CONFIG_NAME = "config"
VERSION_BASE = "1.3"

IS_1_3 = hydra_version.startswith("1.3.")
"""Whether Hydra asks which version to be compatible with; 1.4 warns of whoever tells it."""


@contextmanager
def open_hydra(arguments: Namespace) -> Iterator[None]:
    """Set Hydra up with the search path that these arguments ask for, and clear it afterwards."""
    if IS_1_3:
        version.setbase(VERSION_BASE)
    register()
    search_path = create_config_search_path(arguments.config_path or str(config_folder()))
    if arguments.config_dir:
        search_path.prepend(
            "command-line", f"file://{Path(arguments.config_dir).absolute()}", SearchPathQuery(provider="schema")
        )
    GlobalHydra.instance().clear()
    try:
        hydra = Hydra.create_main_hydra2("multilens", search_path)
        quicken(hydra)
        yield
    finally:
        GlobalHydra.instance().clear()


def quicken(hydra: Hydra) -> None:
    """Have a Hydra that is set up compose what it has composed before from memory; presets must stay as they are meanwhile."""
    # Hydra 1.4 composes in another way, which the quick loader does not know: there every job is composed from its files.
    if not IS_1_3:
        return
    from multilens.app.quick_loader import QuickLoader

    assert isinstance(hydra.config_loader, ConfigLoaderImpl)
    hydra.config_loader = QuickLoader(hydra.config_loader)


def config_loader() -> ConfigLoader:
    """Give the loader of the Hydra that is set up."""
    return GlobalHydra.instance().config_loader()
