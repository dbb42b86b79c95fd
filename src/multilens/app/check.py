"""The whole command line checked before Hydra runs anything: no folder is made for what cannot be run."""

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hydra import compose
from hydra.core.config_loader import ConfigLoader
from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Glob, IntervalSweep, Override
from omegaconf import DictConfig, OmegaConf

from multilens.app import build
from multilens.app.compose import CONFIG_NAME, config_loader, open_hydra
from multilens.app.keys import is_known, no_such_option, unknown_key
from multilens.app.launcher import refuse_foreign_commands, refuse_without_workers
from multilens.app.plain import plain
from multilens.app.refusal import RefusedError, one_line
from multilens.app.schema import Config
from multilens.app.sweep_folder import Sweep, claim_of, sweep_folder, words_of
from multilens.app.telling import told_in_one_line
from multilens.app.yaml_limits import refuse_wild_folders
from multilens.sweeps.claim import Claim

CALLABLE_KEYS = ("_target_", "()", "class")
"""Keys of Hydra's own configuration that make it import and call what they name."""

CALLABLES = (
    "multilens.app.sweep.SweepTable",
    "logging.StreamHandler",
    "colorlog.ColoredFormatter",
)
CALLABLE_PACKAGES = ("hydra._internal.core_plugins.", "hydra_plugins.", "optuna.samplers.")
"""What those keys may name: our table, launchers and sweepers, and logging to the console: a run folder has a log of its own."""

JOB_FOLDER = "${hydra.job.num}"

LOGGING = ("job_logging", "hydra_logging")
"""Parts of Hydra's own configuration that go to Python's logging, which imports the module of any text that begins with ext://."""

STREAMS = ("ext://sys.stdout", "ext://sys.stderr")


@dataclass(frozen=True)
class Checked:
    """What a command line would run.

    Args:
        configs: of each job that was looked at: by "" the one with the first values, by key=value that with another one.
        swept: the keys of which there are several values.
        sweep: the sweep and its folder; None where it is none.
    """

    configs: dict[str, Config]
    swept: tuple[str, ...]
    sweep: Sweep | None


def check_command_line(arguments: Namespace) -> Checked:
    """Compose what would be run, build it as far as torch is not needed, and look at the folder it would go to.

    For a sweep every value of every swept key is looked at, each with the first values of the others.

    Args:
        arguments: as Hydra's parser gives them.

    Returns:
        What would be run.

    Raises:
        RefusedError: something cannot be run; one line.
    """
    refuse_wild_folders(arguments)
    with open_hydra(arguments), told_in_one_line():
        loader = config_loader()
        overrides = parsed(arguments.overrides, loader)
        config_name = arguments.config_name or CONFIG_NAME
        swept = [override for override in overrides if override.is_sweep_override()]
        first = composed(config_name, [_choices(override, loader)[0] for override in overrides])
        is_sweep = arguments.multirun or (first.hydra.mode is not None and first.hydra.mode.name == "MULTIRUN")
        folder = None
        if is_sweep:
            refuse_without_workers(_launcher(first))
            folder = sweep_folder(_folder_of("hydra.sweep.dir", first), first, words_of(arguments))
            swept += _swept_in_files(first, loader)
        else:
            for override in swept:
                raise RefusedError(
                    f"{_line(override)}: several values need multilens -m, or [...] around them where a list is meant"
                )
            _refuse_used("hydra.run.dir", _folder_of("hydra.run.dir", first))
        _refuse_swept_hydra(swept)
        configs: dict[str, Config] = {}
        whole: dict[str, dict[str, Any]] = {}
        # Hydra copies all that it knows to answer this: it is asked once for each key.
        files = {each.get_key_element() for each in swept if loader.get_group_options(each.key_or_group)}
        for changed, lines in _each_value(overrides, swept, loader):
            # A value of ours cannot change what of Hydra's has been looked at; a file can.
            chooses_file = changed.partition("=")[0] in files
            config = composed(config_name, lines) if chooses_file or not changed else compose(config_name, lines)
            configs[changed] = build.typed(config)
            build.check(configs[changed])
            whole[changed] = plain(configs[changed])
    sweep = None if folder is None else Sweep(folder, _claim(overrides, swept, whole))
    return Checked(configs, tuple(override.get_key_element() for override in swept), sweep)


def _claim(overrides: list[Override], swept: list[Override], configs: dict[str, dict[str, Any]]) -> Claim:
    keys = {override.get_key_element(): _line(override).partition("=")[2] for override in swept}
    ours = [override.get_key_element() for override in overrides if not override.is_hydra_override()]
    fixed = [key for key in ours if key not in keys]
    return claim_of(fixed, keys, configs)


def parsed(lines: list[str], loader: ConfigLoader) -> list[Override]:
    """Give the overrides that lines of key=value stand for, once every key and option is known to exist.

    Raises:
        RefusedError: one is unknown, or would have something imported or called.
    """
    overrides = OverridesParser.create(config_loader=loader).parse_overrides(lines)
    for override in overrides:
        if "_target_" in _line(override):
            key = override.key_or_group
            raise RefusedError(
                one_line(f"{_line(override)}: _target_ is an unknown key, {key} can name no class or function")
            )
        key = override.key_or_group
        if key.startswith(("hydra.job_logging", "hydra.hydra_logging")):
            raise RefusedError(
                f"{_line(override)}: what Hydra logs is not set key by key, the run folder has a log of its own"
            )
        if _is_hydras(key):
            if "/" in key and override.value() is None and not override.is_delete():
                raise RefusedError(f"{_line(override)}: must be the name of an option, got null")
            continue
        options = loader.get_group_options(key) if "." not in key else []
        if options and not isinstance(override.value(), dict):
            for choice in named_values(override, loader):
                if "/" not in choice and choice not in options:
                    raise RefusedError(no_such_option(key, choice, options))
        elif not is_known(key.split(".")):
            raise RefusedError(unknown_key(key, _line(override)))
    return overrides


def _is_hydras(key: str) -> bool:
    return key.replace("/", ".").split(".")[0] == "hydra"


def _line(override: Override) -> str:
    return override.input_line or override.key_or_group


def named_values(override: Override, loader: ConfigLoader) -> list[str]:
    """Give what an override sets, as it is written: one value, each of a list, or each of those that it sweeps."""
    if override.is_delete():
        return []
    if override.is_sweep_override():
        return [line.partition("=")[2] for line in _choices(override, loader)]
    value = override.value()
    if value is None:
        return ["null"]
    return [str(one) for one in value] if isinstance(value, list) else [str(value)]


def _choices(override: Override, loader: ConfigLoader) -> list[str]:
    """Give the override once for each value that it sweeps; of an interval, for its two ends."""
    if not override.is_sweep_override():
        return [_line(override)]
    value, key = override.value(), override.get_key_element()
    if isinstance(value, Glob):
        names = value.filter(loader.get_group_options(override.key_or_group))
        if not names:
            raise RefusedError(f"{_line(override)}: matches no option of {override.key_or_group}")
    elif isinstance(value, IntervalSweep):
        names = [str(value.start), str(value.end)]
    else:
        try:
            names = list(override.sweep_string_iterator())
        except ValueError as error:
            raise RefusedError(one_line(f"{_line(override)}: {error}")) from None
        if not names:
            raise RefusedError(f"{_line(override)}: must have one value at least, got none")
    return [f"{key}={name}" for name in names]


def _swept_in_files(config: DictConfig, loader: ConfigLoader) -> list[Override]:
    params = OmegaConf.select(config, "hydra.sweeper.params")
    if not isinstance(params, DictConfig) or "basic_sweeper" not in config.hydra.sweeper._target_:
        return []
    return parsed([f"{key}={value}" for key, value in params.items()], loader)


def _refuse_swept_hydra(swept: list[Override]) -> None:
    """Refuse to sweep what of Hydra's is looked at once; it reads most of it once as well, before the first job."""
    for override in swept:
        if _is_hydras(override.key_or_group):
            raise RefusedError(
                one_line(f"{override.key_or_group} cannot be swept, it is Hydra's own, got {_line(override)}")
            )


def _each_value(
    overrides: list[Override], swept: list[Override], loader: ConfigLoader
) -> Iterator[tuple[str, list[str]]]:
    """Give the words with the first values, and then with each other value, which is told."""
    base = {override.get_key_element(): _choices(override, loader)[0] for override in [*overrides, *swept]}
    yield "", list(base.values())
    for override in swept:
        for line in _choices(override, loader)[1:]:
            yield line, list((base | {override.get_key_element(): line}).values())


def composed(config_name: str, lines: list[str]) -> DictConfig:
    """Compose a configuration, Hydra's own part with it.

    Raises:
        RefusedError: Hydra's part would put files into the run folder, or have something imported, called or run.
    """
    config = compose(config_name, lines, return_hydra_config=True)
    if config.hydra.output_subdir is not None:
        raise RefusedError(
            f"hydra.output_subdir must be null, the run folder is ours alone, got {config.hydra.output_subdir}"
        )
    if config.hydra.job.chdir:
        raise RefusedError("hydra.job.chdir must be null or false, the run folder is put in place at the end, got true")
    own = OmegaConf.to_container(config.hydra, resolve=False)
    assert isinstance(own, dict)
    if variables := own["job"]["env_set"]:
        raise RefusedError(
            one_line(f"hydra.job.env_set must be empty, variables are set in front of the command, got {variables}")
        )
    if (subdir := own["sweep"]["subdir"]) != JOB_FOLDER:
        raise RefusedError(one_line(f"hydra.sweep.subdir must be {JOB_FOLDER}, a job's number, got {subdir}"))
    _refuse_foreign_callables("hydra", own)
    for part in LOGGING:
        _refuse_foreign_objects(f"hydra.{part}", own.get(part))
    refuse_foreign_commands(_launcher(config), lines)
    return config


def _refuse_foreign_callables(key: str, node: Any) -> None:
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for name, child in children:
        below = f"{key}.{name}"
        if name in CALLABLE_KEYS and not (child in CALLABLES or str(child).startswith(CALLABLE_PACKAGES)):
            raise RefusedError(
                one_line(f"{below} must be one of Hydra's launchers, sweepers or console log handlers, got {child}")
            )
        _refuse_foreign_callables(below, child)


def _refuse_foreign_objects(key: str, node: Any) -> None:
    """Refuse what Python's logging would look up by name; an interpolation could become such a name later."""
    if isinstance(node, dict | list):
        for name, child in node.items() if isinstance(node, dict) else enumerate(node):
            _refuse_foreign_objects(f"{key}.{name}", child)
    elif isinstance(node, str) and node not in STREAMS and any(mark in node for mark in ("ext://", "cfg://", "${")):
        raise RefusedError(one_line(f"{key} must be plain text, {' or '.join(STREAMS)}, got {node}"))


@contextmanager
def _as_during_a_run(config: DictConfig) -> Iterator[None]:
    """Let what is told in terms of Hydra's own configuration be known, such as where a folder goes."""
    before = HydraConfig.instance().cfg
    HydraConfig.instance().set_config(config)
    try:
        yield
    finally:
        HydraConfig.instance().cfg = before


def _launcher(config: DictConfig) -> Any:
    with _as_during_a_run(config):
        return OmegaConf.to_container(config.hydra.launcher, resolve=True)


def _folder_of(key: str, config: DictConfig) -> Path:
    with _as_during_a_run(config):
        # The name is part of the folder's: it is looked at before the folder is.
        build.check(build.typed(config))
        return Path(str(OmegaConf.select(config, key)))


def _refuse_used(key: str, folder: Path) -> None:
    if folder.is_dir() and any(folder.iterdir()):
        raise RefusedError(f"{key} must be a new or empty folder, {folder} holds something already")
    if folder.exists() and not folder.is_dir():
        raise RefusedError(f"{key} must be a new or empty folder, {folder} is a file")
