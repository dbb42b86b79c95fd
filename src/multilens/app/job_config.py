"""The configuration of one job, which Hydra copies five times before the job has it.

OmegaConf copies node by node: that took as long as everything else that Hydra does for a job. Nobody else has a job's
configuration, and nothing in it is set once the job runs, so its copies may have the same parts.
"""

from dataclasses import replace
from typing import Any

from omegaconf import DictConfig


class JobConfig(DictConfig):
    """A configuration of which a copy is a dictionary of its own, but of the same parts."""

    def __deepcopy__(self, memo: dict[int, Any]) -> "JobConfig":
        twin = type(self).__new__(type(self))
        own = vars(self)
        metadata = replace(self._metadata, flags=dict(self._metadata.flags or {}))
        vars(twin).update(own | {"_content": dict(own["_content"]), "_metadata": metadata, "_flags_cache": None})
        return twin


def with_common_parts(config: DictConfig) -> DictConfig:
    """Have later copies of a job's configuration, and of Hydra's part of it, share what they hold; give the same configuration."""
    for each in (config.hydra, config):
        # What a configuration holds is set as its attributes are, so that Python's own have to be set past it.
        object.__setattr__(each, "__class__", JobConfig)
    return config
