"""Where the presets lie and which there are; Hydra is not needed to know it."""

from collections.abc import Iterable
from pathlib import Path


def config_folder() -> Path:
    """Give the folder of the presets: inside the package when installed from a wheel, beside src in a checkout."""
    here = Path(__file__).resolve()
    packaged = here.parents[1] / "conf"
    return packaged if packaged.is_dir() else here.parents[3] / "conf"


def preset_groups(folders: Iterable[Path]) -> dict[str, list[str]]:
    """Give the options of every group by its name, such as "depth" or "experiment/devices", both in alphabetical order.

    Args:
        folders: of presets; what is in several of them counts once.
    """
    found: dict[str, set[str]] = {}
    for folder in folders:
        for path in folder.glob("**/*.yaml"):
            group = path.parent.relative_to(folder).as_posix()
            found.setdefault(group, set()).add(path.stem)
    return {group: sorted(found[group]) for group in sorted(found) if group != "."}
