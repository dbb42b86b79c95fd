"""Configurations that differ in plain values alone, composed as Hydra would, but from the files only once.

Hydra composes the configuration of every job anew: it reads thirty files and merges them, for a tenth of a second. In most sweeps
jobs choose the same files, and only values are laid over them: the last thing that Hydra does, so it can be done to a copy.
"""

import pickle
from functools import lru_cache
from secrets import token_hex
from typing import Any

from hydra._internal.config_loader_impl import ConfigLoaderImpl, get_overrides_dirname
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import ConfigCompositionException
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from multilens.app.job_config import with_common_parts

MOST_BASES = 64
"""Choices of files of which the composed configuration is remembered; 30 kB each."""

_bases: dict[tuple[Any, ...], bytes] = {}
_groups: dict[tuple[str, str], bool] = {}
"""Whether a key is a group of files; to look takes as long as half of what is done here."""


class QuickLoader(ConfigLoaderImpl):
    """Hydra's loader of configurations, with a memory; it can be handed to workers, each of which has a memory of its own."""

    def __init__(self, loader: ConfigLoaderImpl) -> None:
        vars(self).update(vars(loader))
        # Files may change between two sweeps of one process.
        self.own = token_hex(8)

    def load_configuration(
        self,
        config_name: str | None,
        overrides: list[str],
        run_mode: RunMode,
        from_shell: bool = True,
        validate_sweep_overrides: bool = True,
    ) -> DictConfig:
        """Compose a configuration; see Hydra's loader."""
        parsed = [_parsed(line) for line in overrides]
        values = [override for override in parsed if self._is_value(override)]
        if run_mode != RunMode.RUN or any(override.is_sweep_override() for override in values):
            return super().load_configuration(config_name, overrides, run_mode, from_shell, validate_sweep_overrides)
        choices = [line for line, override in zip(overrides, parsed, strict=True) if not self._is_value(override)]
        key = (self.own, config_name, *choices)
        if key not in _bases:
            base = super().load_configuration(config_name, choices, run_mode, from_shell, validate_sweep_overrides)
            for part in ("launcher", "sweeper"):
                # A class that a plugin brings is another one in every process, and cannot be pickled there.
                base.hydra[part] = OmegaConf.to_container(base.hydra[part])
            if len(_bases) >= MOST_BASES:
                _bases.pop(next(iter(_bases)))
            _bases[key] = pickle.dumps(base)
        # Our own bytes of a moment ago; six times as fast as a deep copy.
        config = pickle.loads(_bases[key])
        try:
            self._apply_overrides_to_config(values, config)
        except OmegaConfBaseException as error:
            raise ConfigCompositionException from error
        task = [override for override in parsed if not override.is_hydra_override()]
        config.hydra.overrides.task = [override.input_line for override in task]
        naming = config.hydra.job.config.override_dirname
        config.hydra.job.override_dirname = get_overrides_dirname(
            task, naming.exclude_keys, naming.item_sep, naming.kv_sep
        )
        return config

    def load_sweep_config(self, master_config: DictConfig, sweep_overrides: list[str]) -> DictConfig:
        """Compose the configuration of a job; see Hydra's loader."""
        return with_common_parts(super().load_sweep_config(master_config, sweep_overrides))

    def _is_value(self, override: Override) -> bool:
        """Whether an override sets a value of ours, rather than choose a file or set something of Hydra's."""
        if override.is_hydra_override():
            return False
        key = (self.own, override.key_or_group)
        if key not in _groups:
            _groups[key] = self.repository.group_exists(override.key_or_group)
        return not _groups[key] or isinstance(override.value(), dict)


@lru_cache(maxsize=1024)
def _parsed(line: str) -> Override:
    return OverridesParser.create().parse_override(line)
