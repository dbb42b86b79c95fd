"""Where a sweep goes, so that the same command finds it again, and what makes it this sweep."""

from argparse import Namespace
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from multilens.app.ending import tell
from multilens.app.refusal import RefusedError, refused_at
from multilens.storage import made_with
from multilens.sweeps.claim import Claim, claim_folder
from multilens.sweeps.fingerprint import asked, difference, fingerprint
from multilens.sweeps.job import forget_failed
from multilens.sweeps.locks import AGREEMENT, clear_half_written

UNNAMED = "sweeps/${name}"
"""What our configuration says where nobody names a folder."""


@dataclass(frozen=True)
class Sweep:
    """A sweep that has been checked.

    Args:
        folder: where it goes.
        claim: what makes it this sweep.
    """

    folder: Path
    claim: Claim


def words_of(arguments: Namespace) -> list[str]:
    """Give the words of a command line that make a sweep this one: not where it goes, nor on how many cores it runs."""
    ours = [line for line in arguments.overrides if not line.lstrip("+~").startswith("hydra")]
    sweeper = [line for line in arguments.overrides if line.lstrip("+~").startswith(("hydra.sweeper", "hydra/sweeper"))]
    presets = [arguments.config_name, arguments.config_path, arguments.config_dir]
    return [str(word) for word in [*presets, *sweeper, *ours] if word]


def sweep_folder(named: Path, config: DictConfig, words: Sequence[str]) -> Path:
    """Give the folder of a sweep: the one that is named, or one below it that the words decide where nobody names one.

    Args:
        named: by the configuration.
        config: composed with the first values.
        words: see `words_of`.
    """
    hydra = OmegaConf.to_container(config.hydra.sweep, resolve=False)
    assert isinstance(hydra, dict)
    return named / sha256("\n".join(words).encode()).hexdigest()[:8] if hydra["dir"] == UNNAMED else named


def claim_of(fixed: Sequence[str], swept: Mapping[str, str], configs: Mapping[str, Mapping[str, Any]]) -> Claim:
    """Give what makes a sweep this one.

    Args:
        fixed: keys that the command line sets to one value.
        swept: the other keys and their values, as they are written.
        configs: as plain data: by "" with the first values, by key=value with another one.
    """
    versions = made_with()
    others = {line: fingerprint(config, versions) for line, config in configs.items() if line}
    return Claim(tuple(fixed), swept, asked(configs[""]), others, versions)


def open_sweep(sweep: Sweep) -> None:
    """Take the folder for the sweep, and clear away what was interrupted there.

    Raises:
        RefusedError: it is another sweep's, or holds something else; one line.
        OSError: it cannot be read or written.
    """
    with refused_at(f"hydra.sweep.dir: {sweep.folder}"):
        if sweep.folder.exists() and not sweep.folder.is_dir():
            raise ValueError("must be a folder, it is a file")
        claim_folder(sweep.folder, sweep.claim, tell)
    clear_half_written(sweep.folder)
    done = forget_failed(sweep.folder)
    if done:
        print(f"{sweep.folder}: {'1 job is' if done == 1 else f'{done} jobs are'} there from before")
    if (sweep.folder / AGREEMENT).is_dir():
        from multilens.sweeps.agreement import end_moving

        end_moving(sweep.folder)


def refuse_other_versions(claim: Claim) -> None:
    """Refuse to add to a sweep that began with other versions, as on another computer of a cluster.

    Raises:
        RefusedError: one line names the first that differs.
    """
    told = difference(claim.made_with, made_with())
    if told:
        raise RefusedError(f"the sweep was begun elsewhere with other versions: {told}")
